"""Emulated models, a module for each purpose. `tests.ollama_double.brain` says what a module here must have."""
