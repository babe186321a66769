"""The built-in planner: plain English through a grammar, no model."""
