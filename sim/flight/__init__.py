"""One quadrotor: rotors, sensors, estimator and control in the PyBullet world."""
