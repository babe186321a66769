"""Two rooms of 4 x 4 m, a door of 1 m between them at (4, 2), and a drone."""

from wire.site import Site, parse_site

WALLS = (
    ((0.0, 0.0), (8.0, 0.0)),
    ((0.0, 4.0), (8.0, 4.0)),
    ((0.0, 0.0), (0.0, 4.0)),
    ((8.0, 0.0), (8.0, 4.0)),
    ((4.0, 0.0), (4.0, 1.5)),
    ((4.0, 2.5), (4.0, 4.0)),
)


def flat(lintel_m: float = 2.0, **robot: object) -> Site:
    rooms = [("west", "living room", "LivingRoom", 0.0), ("east", "kitchen", "Kitchen", 4.0)]
    row = {"id": "drone-1", "kind": "drone", "start_m": (1.0, 1.0), "link": "udpin://127.0.0.1:14540", **robot}
    return parse_site(
        {
            "name": "flat",
            "room": [
                {
                    "id": id,
                    "name": name,
                    "kind": kind,
                    "polygon_m": [(x, 0.0), (x + 4.0, 0.0), (x + 4.0, 4.0), (x, 4.0)],
                }
                for id, name, kind, x in rooms
            ],
            "wall": [{"start_m": a, "end_m": b} for a, b in WALLS],
            "door": [
                {
                    "id": "door-1",
                    "rooms": ["west", "east"],
                    "start_m": (4.0, 1.5),
                    "end_m": (4.0, 2.5),
                    "height_m": lintel_m,
                }
            ],
            "robot": [row],
            "process": [
                {"id": "hub", "role": "hub", "module": "hub"},
                {"id": "drone-1", "role": "robot", "module": "devices.drone"},
            ],
        },
        "test",
    )
