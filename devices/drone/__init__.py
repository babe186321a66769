"""Drones: skills over an autopilot that speaks MAVLink."""
