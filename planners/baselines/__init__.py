"""Published planners to compare with, adapted to the actions that the robots here have."""
