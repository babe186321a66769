"""The contract: every message, key, frame and clock that the processes share."""
