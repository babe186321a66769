"""What everybody knows about things: typical sizes, what opens, what holds what, in which rooms. No site's facts.

Sizes are (depth along x, width along y, height along z) in metres of the median model; the front of a thing faces
its own +x. Source of the figures: statistics of public household assets, see `docs/catalogue.md`.
"""

import json
from functools import lru_cache
from importlib.resources import files
from typing import Literal

from wire.model import Message, Vec3

RoomKind = Literal["Kitchen", "LivingRoom", "Bedroom", "Bathroom"]


class ObjectType(Message):
    """One type of object."""

    name: str
    kind: Literal["pickup", "moveable", "static", "structure"]
    flags: tuple[str, ...]
    size_m: Vec3
    size_p10_m: Vec3
    size_p90_m: Vec3
    receptacle_mode: Literal["on", "open_top", "enclosed"] | None
    must_open: bool
    """Must be open before anything is put in or taken out."""
    room_weights: dict[RoomKind, float]
    placement: tuple[str, ...]
    allowed_in: tuple[str, ...]
    """Receptacle types that commonly hold it."""
    holds: dict[str, float]
    """P(type present | a receptacle of this type)."""
    mass_kg: float | None = None
    """Of a typical thing that is carried; None where nobody carries it or nobody knows."""
    modelled: bool
    """The simulator has a body for it and the embedded detector knows it."""

    def can(self, flag: str) -> bool:
        return flag in self.flags


@lru_cache(maxsize=1)
def catalogue() -> dict[str, ObjectType]:
    """Every type by name."""
    rows = json.loads(files("wire").joinpath("catalogue.json").read_text())
    return {
        name: ObjectType.model_validate(
            {"name": name, **{k: tuple(v) if isinstance(v, list) else v for k, v in row.items()}}
        )
        for name, row in rows.items()
    }


@lru_cache(maxsize=256)
def type_row(name: str) -> ObjectType:
    """The row of a type; one that the catalogue does not know stands there and can be looked at, nothing more."""
    return catalogue().get(name) or _UNKNOWN.model_copy(update={"name": name})


@lru_cache(maxsize=1)
def modelled_types() -> tuple[str, ...]:
    """Types that can appear in pictures, in the order of the detector's classes."""
    return tuple(sorted(name for name, row in catalogue().items() if row.modelled))


_UNKNOWN = ObjectType(
    name="Unknown",
    kind="static",
    flags=(),
    size_m=(0.3, 0.3, 0.3),
    size_p10_m=(0.1, 0.1, 0.1),
    size_p90_m=(0.5, 0.5, 0.5),
    receptacle_mode=None,
    must_open=False,
    room_weights={},
    placement=(),
    allowed_in=(),
    holds={},
    modelled=False,
)

PROPS: tuple[str, ...] = ("isOpen", "isToggled", "isDirty", "isSliced")
"""The dynamic properties of equation 4 that cameras report, in the order of the detector's outputs."""

PROP_FLAG = {"isOpen": "openable", "isToggled": "toggleable", "isDirty": "dirtyable", "isSliced": "sliceable"}
"""The flag of a type that has the property."""

SMART_TYPES = ("CoffeeMachine", "DeskLamp", "FloorLamp", "Fridge", "Microwave", "Television", "Toaster")
"""Types whose smart appliances report their own state, each named by its type and a number: `television-1`."""

REPORTED = ("isOpen", "isToggled")
"""The properties that smart appliances report."""
