"""From goals to a plan graph: what every planner that reasons about goals shares."""
