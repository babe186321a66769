"""Smart appliances: they say themselves whether they are open or on, at every change and every few seconds."""

from sim.boxes import body_box
from sim.scene import Scene
from wire.catalogue import REPORTED, SMART_TYPES, catalogue
from wire.messages.driver import DeviceReport

EVERY_S = 5.0


class Appliances:
    """Named by type and number in order of place (`television-1`), as an owner would label them."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._keys: dict[str, int] = {}
        for kind in SMART_TYPES:
            found = sorted((b.position_m, b.key) for b in scene.bodies.values() if b.type == kind)
            self._keys |= {f"{kind.lower()}-{n}": key for n, (_, key) in enumerate(found, start=1)}
        self._said: dict[str, tuple[float, dict[str, bool]]] = {}
        self._seq = dict.fromkeys(self._keys, 0)

    @property
    def ids(self) -> list[str]:
        return list(self._keys)

    def reports(self, now_s: float) -> list[DeviceReport]:
        """Those that are due, before any fault."""
        return [self._report(id, key, now_s) for id, key in self._keys.items() if self._is_due(id, key, now_s)]

    def _is_due(self, id: str, key: int, now_s: float) -> bool:
        if id not in self._said:
            return True
        at_s, props = self._said[id]
        return props != self._props(key) or now_s >= at_s + EVERY_S - 1e-9

    def _props(self, key: int) -> dict[str, bool]:
        body = self._scene.bodies[key]
        return {name: body.props[name] for name in REPORTED if name in body.props}

    def _report(self, id: str, key: int, now_s: float) -> DeviceReport:
        body, props = self._scene.bodies[key], self._props(key)
        self._said[id] = (now_s, props)
        self._seq[id] += 1
        return DeviceReport(
            device=id,
            seq=self._seq[id] - 1,
            stamp_s=now_s,
            type=catalogue()[body.type].name,
            position_enu_m=body_box(body).centre_m,
            props={name: 1.0 if value else 0.0 for name, value in props.items()},
        )
