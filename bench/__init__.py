"""Measurements: what the machine does, as ratios taken side by side in one run."""
