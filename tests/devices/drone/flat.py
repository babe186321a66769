"""The two rooms of `tests.devices.rooms`, and a drone."""

from tests.devices.rooms import building
from wire.site import Site, parse_site


def flat(lintel_m: float = 2.0, **robot: object) -> Site:
    row = {"id": "drone-1", "kind": "drone", "start_m": (1.0, 1.0), "link": "udpin://127.0.0.1:14540", **robot}
    return parse_site(
        {
            "name": "flat",
            **building(("living room", "LivingRoom"), ("kitchen", "Kitchen"), height_m=lintel_m),
            "robot": [row],
            "process": [
                {"id": "hub", "role": "hub", "module": "hub"},
                {"id": "drone-1", "role": "robot", "module": "devices.drone"},
            ],
        },
        "test",
    )
