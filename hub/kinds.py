"""What the catalogue says of a type, as numbers that association and containment need at every observation."""

from dataclasses import dataclass
from functools import lru_cache
from math import hypot

from wire.catalogue import ObjectType, catalogue

BLADES = ("Knife", "ButterKnife")
"""What must be in the hand that slices."""
_SAME_SIZE = 1.8
"""Two types whose every dimension differs by less than this factor may be taken for each other."""


@dataclass(frozen=True, slots=True)
class Shape:
    """One type, digested."""

    kind: str
    height_m: float
    half_diagonal_m: float
    half_width_m: float
    """Half of the smaller side of its footprint."""
    gate_m2: float
    """Variance added when two sights are compared: the centre of a big thing half seen is uncertain."""
    walk_m2_per_s: float
    """How fast doubt about its place grows while nobody looks."""
    half_life_s: float
    """After this long unseen, half of the confidence is gone."""
    receptacle_mode: str | None
    encloses: bool
    must_open: bool
    openable: bool
    confusable: frozenset[str]


_WALK = {"pickup": 2e-5, "moveable": 2e-6, "static": 0.0, "structure": 0.0}
_HALF_LIFE = {"pickup": 1800.0, "moveable": 4 * 3600.0, "static": 30 * 24 * 3600.0, "structure": 30 * 24 * 3600.0}


@lru_cache(maxsize=1)
def shapes() -> dict[str, Shape]:
    """Every type's shape by name."""
    types = catalogue()
    return {name: _digest(row, types) for name, row in types.items()}


def shape(name: str) -> Shape:
    """The shape of a type; one the catalogue does not know is treated as a small thing."""
    return shapes().get(name, _UNKNOWN)


def _digest(row: ObjectType, types: dict[str, ObjectType]) -> Shape:
    depth, width, height = row.size_m
    return Shape(
        kind=row.kind,
        height_m=height,
        half_diagonal_m=hypot(depth, width) / 2.0,
        half_width_m=min(depth, width) / 2.0,
        gate_m2=(0.15 * max(depth, width)) ** 2 + 0.03**2,
        walk_m2_per_s=_WALK[row.kind],
        half_life_s=_HALF_LIFE[row.kind],
        receptacle_mode=row.receptacle_mode,
        encloses=row.receptacle_mode == "enclosed",
        must_open=row.must_open,
        openable=row.can("openable"),
        confusable=frozenset(other.name for other in types.values() if _alike(row, other)),
    )


def _alike(a: ObjectType, b: ObjectType) -> bool:
    if a.name == b.name or (a.kind == "pickup") != (b.kind == "pickup") or not (a.modelled and b.modelled):
        return False
    pairs = zip((*sorted(a.size_m[:2]), a.size_m[2]), (*sorted(b.size_m[:2]), b.size_m[2]), strict=True)
    return all(max(p, q) <= _SAME_SIZE * min(p, q) + 0.03 for p, q in pairs)


_UNKNOWN = Shape("pickup", 0.1, 0.1, 0.05, 0.01, 2e-5, 1800.0, None, False, False, False, frozenset())
