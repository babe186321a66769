"""Seeded furnished homes."""

from sim.generator.home import make_home

__all__ = ["make_home"]
