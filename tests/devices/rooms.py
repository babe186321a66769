"""Two rooms of 4 x 4 m side by side with a door of 1 m between them at (4, 2), as a site file has them."""

from wire.model import Vec2

WALLS: tuple[tuple[Vec2, Vec2], ...] = (
    ((0.0, 0.0), (8.0, 0.0)),
    ((0.0, 4.0), (8.0, 4.0)),
    ((0.0, 0.0), (0.0, 4.0)),
    ((8.0, 0.0), (8.0, 4.0)),
    ((4.0, 0.0), (4.0, 1.5)),
    ((4.0, 2.5), (4.0, 4.0)),
)


def building(west: tuple[str, str], east: tuple[str, str], **door: object) -> dict[str, object]:
    """Its rooms, by name and kind, walls and door."""
    rooms = (("west", *west, 0.0), ("east", *east, 4.0))
    between = {"id": "door-1", "rooms": ["west", "east"], "start_m": (4.0, 1.5), "end_m": (4.0, 2.5)}
    return {
        "room": [
            {"id": id, "name": name, "kind": kind, "polygon_m": [(x, 0.0), (x + 4.0, 0.0), (x + 4.0, 4.0), (x, 4.0)]}
            for id, name, kind, x in rooms
        ],
        "wall": [{"start_m": a, "end_m": b} for a, b in WALLS],
        "door": [between | door],
    }
