"""A stand-in for an Ollama server, over real HTTP: for tests and rehearsals where there is no model."""
