"""A real simulated quadrotor with the firmware on it, in simulated time."""

import math
from collections.abc import Callable

import pybullet

from sim.autopilot.firmware import Firmware
from sim.autopilot.interface import Ack, Answer, Command, Item, PositionTarget, Severity
from sim.autopilot.personality import PERSONALITIES
from sim.bullet import STEP_S
from sim.flight.world import BareFloor

NAN = math.nan
ZURICH = (47.397742, 8.545594, 488.0)


class Rig:
    def __init__(self, name="ardupilot", gps="fused", ceiling_m=math.inf, seed=0, settle_s=1.0):
        self.world = BareFloor(seed=seed, fixes=gps == "fused", altitude_m=ZURICH[2])
        self.vehicle = self.world.vehicles[0]
        self.firmware = Firmware(self.vehicle, PERSONALITIES[name], 1, ZURICH, gps, ceiling_m)
        self.now_s = 0.0
        self.said: list[tuple[Severity, str]] = []
        self.every: Callable[[], None] | None = None
        self.fly(settle_s)

    def close(self):
        self.world.close()

    def fly(self, span_s: float, until: Callable[[], bool] | None = None) -> bool:
        """Let time pass, at most until something holds; whether it does."""
        steps = round(span_s / STEP_S)
        for k in range(steps):
            self.now_s = self.world.now_s
            if k % 12 == 0:
                if self.every is not None:
                    self.every()
                if until is not None and until():
                    return True
            self.firmware.step(self.now_s)
            self.world.advance(STEP_S)
        self.said += self.firmware.texts()
        return until is not None and until()

    def heard(self, words: str) -> bool:
        self.said += self.firmware.texts()
        return any(words.lower() in text.lower() for _, text in self.said)

    def do(self, id: int, *params: float, x=0.0, y=0.0, z=0.0, frame=None) -> Answer:
        four = tuple((*params, 0.0, 0.0, 0.0, 0.0)[:4])
        answer = self.firmware.command(Command(id, four, x, y, z, frame), self.now_s)
        if answer.text:
            self.said.append((Severity.WARNING, answer.text))
        return answer

    def mode(self, name: str) -> Answer:
        answer = self.firmware.set_mode(1, self.firmware.now.row.modes[name], self.now_s)
        if answer.text:
            self.said.append((Severity.WARNING, answer.text))
        return answer

    def in_mode(self, name: str) -> bool:
        return self.report.custom_mode == self.firmware.now.row.modes[name]

    @property
    def report(self):
        return self.firmware.telemetry(self.now_s)

    @property
    def true_ned(self):
        (east, north, up), _ = self.vehicle.true_pose()
        return north, east, -up

    def off(self, north: float, east: float, down: float) -> float:
        return math.dist(self.true_ned, (north, east, down))

    def tip_over(self) -> None:
        """Throw it on its back: up and half a turn about its nose."""
        bullet, body = self.world.bullet, self.vehicle.body
        (x, y, z), _ = bullet.getBasePositionAndOrientation(body)
        for k in range(40):
            angle = math.pi * k / 39
            quaternion = bullet.getQuaternionFromEuler((angle, 0.0, math.pi / 2))
            pybullet.resetBasePositionAndOrientation(
                body, (x, y, max(z, 0.3)), quaternion, physicsClientId=bullet.client
            )
            bullet.resetBaseVelocity(body, (0.0, 0.0, 0.0), (0.0, math.pi / 39 * 240, 0.0))
            self.fly(1 / 240)
        bullet.resetBaseVelocity(body, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))

    def take_off(self, height_m=1.5) -> None:
        """Armed and hovering at a height, in hold or guided mode."""
        if self.firmware.now.row.name == "ardupilot":
            assert self.mode("offboard").result is Ack.ACCEPTED
        else:
            self.firmware.set_param("MIS_TAKEOFF_ALT", height_m)
        assert self.do(400, 1).result is Ack.ACCEPTED, self.said
        self.fly(0.2)
        height = height_m if self.firmware.now.row.name == "ardupilot" else NAN
        assert self.do(22, NAN, NAN, NAN, NAN, x=NAN, y=NAN, z=height).result is Ack.ACCEPTED, self.said
        assert self.fly(10, lambda: abs(self.true_ned[2] + height_m) < 0.2), self.true_ned
        self.fly(1.0)

    def target(
        self,
        frame=1,
        mask=0x9F8,
        position=(0.0, 0.0, 0.0),
        velocity=(0.0, 0.0, 0.0),
        accel=(0.0, 0.0, 0.0),
        yaw=0.0,
        rate=0.0,
    ):
        self.firmware.position_target(PositionTarget(frame, mask, position, velocity, accel, yaw, rate), self.now_s)

    def stream(self, **target) -> None:
        """The same setpoint again and again, at 20 Hz."""
        self.every = lambda: self.target(**target)
        self.every()

    def offboard(self, **target) -> None:
        self.stream(**target)
        assert self.mode("offboard").result is Ack.ACCEPTED, self.said


def item(seq, command, x=0.0, y=0.0, z=0.0, params=(0.0, 0.0, 0.0, 0.0), frame=1) -> Item:
    return Item(seq, frame, command, False, True, params, x, y, z)


def ardupilot(rig: Rig) -> bool:
    return rig.firmware.now.row.name == "ardupilot"


def put(rig: Rig, **values: float) -> None:
    """Set parameters."""
    for name, value in values.items():
        assert not isinstance(rig.firmware.set_param(name, value), str), name


def upload(rig, items) -> int:
    """With a home before it where the firmware has that."""
    first = rig.firmware.now.row.home_is_item_0
    shifted = [
        item(k, i.command, i.x, i.y, i.z, i.params, i.frame)
        for k, i in enumerate(([item(0, 16)] if first else []) + items)
    ]
    return rig.firmware.accept_plan(0, shifted)


def start(rig) -> None:
    if rig.firmware.now.row.name == "ardupilot":
        rig.mode("offboard")
    assert rig.do(400, 1).result is Ack.ACCEPTED
    assert rig.do(300).result is Ack.ACCEPTED, rig.said
    assert rig.in_mode("mission")
