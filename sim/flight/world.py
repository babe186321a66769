"""Vehicles over a bare floor: for measurements and for a simulator without a house."""

from math import pi
from typing import Any

from sim.bullet import STEP_S, add_floor, open_bullet
from sim.flight.quadrotor import Quadrotor

_FLOOR, _FIRST = 4, 16
_EVERYTHING = 0x7FFFFFFF
_APART_M = 1.5


class BareFloor:
    """`count` quadrotors in a row to the east, looking north; time begins at 0."""

    def __init__(self, count: int = 1, seed: int = 0, fixes: bool = True, altitude_m: float = 0.0) -> None:
        self.bullet: Any = open_bullet()
        bullet = self.bullet
        add_floor(bullet, _FLOOR, _EVERYTHING)
        self.vehicles = [
            Quadrotor(
                bullet,
                f"drone-{k + 1}",
                (_APART_M * k, 0.0, 0.0),
                pi / 2.0,
                seed + k,
                _FIRST,
                _EVERYTHING,
                fixes,
                altitude_m,
            )
            for k in range(count)
        ]
        self.steps = 0

    @property
    def now_s(self) -> float:
        return self.steps * STEP_S

    def advance(self, span_s: float) -> None:
        """As many whole steps of physics as fit."""
        for _ in range(round(span_s / STEP_S)):
            now_s = self.now_s
            for vehicle in self.vehicles:
                vehicle.before_step(now_s)
            self.bullet.stepSimulation()
            self.steps += 1

    def close(self) -> None:
        self.bullet.disconnect()
