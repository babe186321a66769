"""Quadrupeds: skills over a velocity driver and a gripper."""
