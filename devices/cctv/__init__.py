"""Fixed cameras: pictures in, observations and an event log out."""
