"""The second paper's reasoning layer: sub-tasks for kinds of robots, their motion functions, one map of all that was seen."""
