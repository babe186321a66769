"""Where things rest in or on a receptacle, in its own frame: agreed between models and hands."""

from dataclasses import dataclass
from itertools import pairwise

from sim.scene import Body, Vec2

ARM_CHAIR_SEAT, SOFA_SEAT, CHAIR_SEAT, BED_TOP = 0.48, 0.46, 0.52, 0.58
"""Height of the seat as a part of the whole."""
TOILET_SEAT = 0.42
COFFEE_TRAY = 0.12
BOARD_M = 0.03
OPEN_AIR_M = 10.0
FRIDGE_SHELVES = (0.08, 0.36, 0.60, 0.80)
"""Height of the fridge's boards as a part of the whole."""


@dataclass(frozen=True)
class Surface:
    """A level rectangle that carries things; `room_above_m` is how tall they can be."""

    centre_m: Vec2
    size_m: Vec2
    height_m: float
    room_above_m: float


def surfaces(body: Body) -> tuple[Surface, ...]:
    """The places of a receptacle, the best first; empty for what holds nothing."""
    d, w, h = body.size_m
    if body.type in _TOPS:
        return (Surface((0.0, 0.0), (d - 0.04, w - 0.04), h, OPEN_AIR_M),)
    if body.type in _SEATS:
        part, back, arms = _SEATS[body.type]
        return (Surface((d * back / 2.0, 0.0), (d * (1.0 - back), w * (1.0 - 2.0 * arms)), h * part, OPEN_AIR_M),)
    if body.type in ("ShelvingUnit", "Fridge"):
        return _boards(body)
    if body.type == "CoffeeMachine":
        return (Surface((d * 0.2, 0.0), (d * 0.5, w * 0.5), h * COFFEE_TRAY, h * 0.45),)
    if body.type == "Toilet":
        return (Surface((-d * 0.39, 0.0), (d * 0.20, w * 0.9), h, OPEN_AIR_M),)
    if body.type in _INSIDES:
        wall, floor = _INSIDES[body.type]
        return (Surface((0.0, 0.0), (d - 2.0 * wall, w - 2.0 * wall), floor, h - floor - 0.01),)
    if body.type in _DISHES:
        across, floor = _DISHES[body.type]
        return (Surface((0.0, 0.0), (d * across, w * across), h * floor, OPEN_AIR_M),)
    if body.type == "Sink":
        return (Surface((0.06, 0.0), (d - 0.2, w - 0.14), sink_floor_m(h), OPEN_AIR_M),)
    return ()


def shelf_heights_m(height_m: float) -> tuple[float, ...]:
    """Upper faces of the boards of a shelving unit; the topmost is its top."""
    count = max(3, round(height_m / 0.42))
    return tuple(BOARD_M + 0.05 + (height_m - BOARD_M - 0.05) * k / (count - 1) for k in range(count))


def sink_floor_m(height_m: float) -> float:
    """Bottom of the basin: on a counter near its foot, on a pedestal at hip height."""
    return 0.02 if height_m < 0.5 else height_m - 0.26


_TOPS = ("CoffeeTable", "CounterTop", "Desk", "DiningTable", "Dresser", "SideTable", "TVStand", "Toaster")
_SEATS = {
    "ArmChair": (ARM_CHAIR_SEAT, 0.30, 0.17),
    "Sofa": (SOFA_SEAT, 0.30, 0.07),
    "Chair": (CHAIR_SEAT, 0.12, 0.02),
    "Bed": (BED_TOP, 0.06, 0.02),
}
_INSIDES = {
    "Box": (0.02, 0.012),
    "GarbageCan": (0.05, 0.02),
    "LaundryHamper": (0.03, 0.03),
    "Microwave": (0.04, 0.03),
}
_DISHES = {"Plate": (0.6, 0.5), "Bowl": (0.5, 0.25), "Pan": (0.45, 0.3), "Pot": (0.5, 0.1), "Mug": (0.4, 0.1)}


def _boards(body: Body) -> tuple[Surface, ...]:
    d, w, h = body.size_m
    if body.type == "Fridge":
        heights = [*(h * part for part in FRIDGE_SHELVES), h - 0.04]
        size, x = (d * 0.55, w - 0.12), -d * 0.08
    else:
        heights = [*shelf_heights_m(h)]
        size, x = (d - 0.06, w - 0.10), 0.01
    rows = [Surface((x, 0.0), size, low, high - low - BOARD_M) for low, high in pairwise(heights)]
    # What is neither on the ground nor above the head is best.
    return tuple(sorted(rows, key=lambda s: (abs(s.height_m - 0.8), s.height_m)))
