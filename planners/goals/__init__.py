"""The planner that has a language model translate what the grammar refuses into goals; plans are made by code."""
