"""Things, a hand and a camera for the test driver; and eyes that are told what is where (a fixture, not perception)."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import atan, cos, hypot, sin

import numpy as np

from devices.quadruped.look import Look, Thing
from tests.devices.driver import Driver
from wire.bus import Event
from wire.frames import project
from wire.messages.driver import CameraFrame, GripperCommand, GripperState
from wire.messages.observation import ObservationBatch

REACH_M, HAND_S = 1.2, 1.0


@dataclass
class Item:
    type: str
    x: float
    y: float
    z: float
    half_m: float = 0.05
    openable: bool = False
    open: bool = False
    inside: "Item | None" = None
    on: bool = False


@dataclass
class Workshop(Driver):
    """The test driver with a hand and a mast camera."""

    site: object
    items: list[Item] = field(default_factory=list)
    held: Item | None = None

    def __post_init__(self) -> None:
        super().__init__(self.site)
        self.tilt = 0.3
        self.done: list[GripperCommand] = []
        self.state = GripperState(robot="dog-1", seq=0, stamp_s=0.0, holding=False)
        self._busy: tuple[float, GripperCommand] | None = None

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        super().step(now_s, events)
        if self._seq % 10 == 5:
            self.node.publish("frame", self.frame(now_s), "dog-1")

    def frame(self, now_s: float) -> CameraFrame:
        self.tilt = self.velocity.camera_tilt_down_rad
        return CameraFrame(
            camera="dog-1",
            seq=self._seq,
            stamp_s=now_s,
            width_px=320,
            height_px=240,
            focal_px=160.0,
            position_enu_m=(self.x + 0.2 * cos(self.yaw), self.y + 0.2 * sin(self.yaw), 1.3),
            yaw_rad=self.yaw,
            tilt_down_rad=self.tilt,
            jpeg=b"",
        )

    def grip(self, now_s: float) -> None:
        """One second after a command the hand says what came of it."""
        for command in self.grips:
            self._busy = (now_s + HAND_S, command)
        self.grips.clear()
        if self._busy is None or now_s < self._busy[0]:
            return
        command, self._busy = self._busy[1], None
        self.done.append(command)
        reason = self._do(command)
        state = GripperState(
            robot="dog-1",
            seq=self._seq,
            stamp_s=now_s,
            holding=self.held is not None,
            holding_type=self.held.type if self.held else None,
            command_id=command.command_id,
            ok=not reason,
            reason=reason,
            point_enu_m=command.point_enu_m,
        )
        self.node.publish("gripper_state", state, "dog-1")

    def _do(self, command: GripperCommand) -> str:
        x, y, _ = command.point_enu_m
        near = [i for i in self.items if hypot(i.x - x, i.y - y) < i.half_m + 0.15 and i.type == command.expected_type]
        if not near:
            return "there is nothing at this point"
        item = near[0]
        if hypot(item.x - self.x, item.y - self.y) - item.half_m > REACH_M:
            return f"the {item.type} is out of reach"
        match command.action:
            case "pickup" if item.inside is not None and not item.inside.open:
                return f"the {item.inside.type} around it is closed"
            case "pickup":
                self.items.remove(item)
                self.held = item
            case "put" if item.openable and not item.open:
                return f"the {item.type} is closed"
            case "put" if self.held is not None:
                self.held.x, self.held.y, self.held.inside = item.x, item.y, item
                self.items.append(self.held)
                self.held = None
            case "open" | "close":
                if item.open == (command.action == "open"):
                    return f"the {item.type} is already so"
                item.open = not item.open
            case "toggle_on" | "toggle_off":
                item.on = command.action == "toggle_on"
        return ""


class ToldEyes:
    """Sees every item in the picture's frame within 5 m that no wall hides."""

    def __init__(self, workshop: Workshop) -> None:
        self._workshop = workshop
        self.carried: list[bool] = []

    def look(self, frame: CameraFrame, carrying: bool, boot_id: str) -> tuple[Look, ObservationBatch]:
        self.carried.append(carrying)
        things = tuple(self._thing(item) for item in self._workshop.items if self._visible(item, frame))
        look = Look(
            frame.stamp_s,
            frame.position_enu_m[:2],
            frame.yaw_rad,
            2.0 * atan(1.0),
            things,
            np.zeros((0, 3), np.float32),
        )
        batch = ObservationBatch(source="dog-1", boot_id=boot_id, seq=frame.seq, stamp_s=frame.stamp_s, kind="robot")
        return look, batch

    def _thing(self, item: Item) -> Thing:
        return Thing(item.type, 0.9, (item.x + 0.02, item.y - 0.02, item.z), {"isOpen": float(item.open)})

    def _visible(self, item: Item, frame: CameraFrame) -> bool:
        if item.inside is not None and item.inside.openable and not item.inside.open:
            return False
        x, y, z = frame.position_enu_m
        if hypot(item.x - x, item.y - y) > 5.0 or (x < 4.0) != (item.x < 4.0):
            return False
        pixel = project((item.x, item.y, item.z), (x, y, z), frame.yaw_rad, frame.tilt_down_rad, 320, 240, 160.0)
        return pixel is not None and 0.0 <= pixel[0] < 320.0 and 0.0 <= pixel[1] < 240.0
