"""The simulated building: a drop-in for the drivers of real hardware."""
