"""The figures homes are drawn from: room mixes, floor areas, doors, sizes. Sources: published statistics of
procedurally generated and hand-made indoor scenes (ProcTHOR's mixes and doors, iTHOR's furniture)."""

from random import Random

from sim.scene import Vec3
from wire.catalogue import RoomKind, catalogue

K: RoomKind = "Kitchen"
L: RoomKind = "LivingRoom"
B: RoomKind = "Bedroom"
W: RoomKind = "Bathroom"

House = tuple[float, tuple[RoomKind, ...], tuple[float, float]]
HOUSES: tuple[House, ...] = (
    (3.0, (K, L, B, W), (84.0, 104.0)),
    (3.0, (K, L, B, B, W), (86.0, 116.0)),
    (2.0, (K, L, B, B, W, W), (92.0, 128.0)),
    (1.0, (K, L, L, B, B, W), (98.0, 134.0)),
    (1.0, (K, L, L, B, B, B, W), (106.0, 138.0)),
    (0.5, (K, L, L, B, B, B, W, W), (118.0, 138.0)),
)
"""Weight, rooms, floor in square metres between these."""

ROOM_SHARE: dict[RoomKind, float] = {K: 1.2, L: 1.9, B: 1.25, W: 0.6}
"""How much of the floor a room gets beside the others."""

ROOM_NAME: dict[RoomKind, tuple[str, str]] = {
    K: ("kitchen", "kitchen"),
    L: ("living-room", "living room"),
    B: ("bedroom", "bedroom"),
    W: ("bathroom", "bathroom"),
}

NARROWEST_M = 2.4
"""Between the middles of opposite walls."""
LONGEST_BY_WIDTH = 2.2
WALL_HEIGHT_M = 2.5
WALL_THICKNESS_M = 0.1
SINGLE_DOOR_M, DOUBLE_DOOR_M, DOOR_HEIGHT_M = (1.0, 1.08), (1.91, 2.0), (2.07, 2.13)
OPEN_KITCHEN_SHARE, DOUBLE_DOOR_SHARE = 0.75, 0.15

SIZE_LIMITS_M: dict[str, tuple[Vec3, Vec3]] = {
    "Bed": ((1.9, 1.1, 0.75), (2.15, 1.6, 1.0)),
    "CounterTop": ((0.62, 1.8, 0.92), (0.68, 2.7, 0.95)),
    "Desk": ((0.50, 1.05, 0.72), (0.70, 1.5, 0.80)),
    "DiningTable": ((0.75, 1.1, 0.70), (1.0, 1.6, 0.78)),
    "Dresser": ((0.40, 0.80, 0.72), (0.55, 1.4, 1.05)),
    "HousePlant": ((0.26, 0.26, 0.48), (0.48, 0.48, 0.95)),
    "Painting": ((0.025, 0.575, 0.489), (0.035, 0.938, 0.70)),
    "ShelvingUnit": ((0.28, 0.68, 1.0), (0.40, 1.05, 1.75)),
    "SideTable": ((0.36, 0.42, 0.50), (0.48, 0.70, 0.70)),
    "Sofa": ((0.82, 1.74, 0.79), (1.0, 2.3, 0.95)),
    "TVStand": ((0.40, 1.05, 0.45), (0.60, 1.42, 0.65)),
    "Television": ((0.12, 1.0, 0.68), (0.30, 1.25, 0.80)),
}
"""Smallest and largest where the catalogue's 10th and 90th percentiles suit no room of an ordinary home."""


def draw_size_m(kind: str, rng: Random) -> Vec3:
    """A size between the 10th and the 90th percentile, the same quantile along every axis."""
    row, q = catalogue()[kind], rng.random()
    if kind in SIZE_LIMITS_M:
        (x0, y0, z0), (x1, y1, z1) = SIZE_LIMITS_M[kind]
        x, y, z = rng.uniform(x0, x1), rng.uniform(y0, y1), rng.uniform(z0, z1)
    else:
        x, y, z = (
            a + (m - a) * 2.0 * q if q < 0.5 else m + (b - m) * (2.0 * q - 1.0)
            for a, m, b in zip(row.size_p10_m, row.size_m, row.size_p90_m, strict=True)
        )
    return (round(x, 3), round(y, 3), round(z, 3))
