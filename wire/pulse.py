"""A process's heartbeat: two `Health` a second on the mesh's clock, sent by the loop that decides."""

from typing import Literal

from wire.bus import Node
from wire.messages.clock import Health

PERIOD_S = 0.5
Mode = Literal["starting", "ready", "busy", "holding", "stopping"]


class Pulse:
    """Beats through `node` when it is due."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._seq = 0
        self._due_s = 0.0
        self._last_s: float | None = None

    @property
    def due_s(self) -> float:
        """When the next beat is due."""
        return self._due_s

    def beat(self, now_s: float, mode: Mode = "ready") -> None:
        """Called once in every pass of the loop. `loop_age_ms` is the time between the last two passes."""
        age_s = 0.0 if self._last_s is None else max(0.0, now_s - self._last_s)
        self._last_s = now_s
        if now_s < self._due_s - 1e-6 and mode == "ready" and self._due_s - now_s <= PERIOD_S:
            return
        self._due_s = now_s + PERIOD_S
        health = Health(
            process=self._node.id,
            boot_id=self._node.boot_id,
            seq=self._seq,
            stamp_s=now_s,
            loop_age_ms=round(age_s * 1000.0, 3),
            mode=mode,
        )
        self._seq += 1
        self._node.publish("health", health, self._node.id)
