"""A kinematic robot driver for tests: legs, lidar and a gripper in a floor plan of walls and boxes."""

from collections.abc import Sequence
from math import cos, hypot, sin
from random import Random

import numpy as np

from tests.devices.rooms import building
from wire.bus import Event, Node, Received, Reply
from wire.messages.command import (
    CancelRequest,
    Command,
    CommandAck,
    GoalsReply,
    GoalsRequest,
    Result,
    TrafficOrder,
)
from wire.messages.driver import GripperCommand, GripperState, LaserScan, Odometry, VelocityCommand
from wire.site import Site, parse_site

BEAMS, RANGE_M, RADIUS_M = 120, 6.0, 0.38
Segment = tuple[float, float, float, float]


def two_rooms(lost_hub_s: float = 2.0) -> Site:
    """The two rooms of `tests.devices.rooms`, and a dog."""
    return parse_site(
        {
            "name": "two-rooms",
            **building(("west", "LivingRoom"), ("east", "LivingRoom")),
            "robot": [{"id": "dog-1", "kind": "quadruped", "start_m": (1.0, 1.0), "lost_hub_s": lost_hub_s}],
            "process": [
                {"id": "hub", "role": "hub", "module": "hub"},
                {"id": "dog-1", "role": "robot", "module": "devices.quadruped"},
            ],
        },
        "test",
    )


def box(x: float, y: float, width: float, depth: float) -> list[Segment]:
    """The four sides of a box whose middle is at (x, y)."""
    x0, x1, y0, y1 = x - width / 2, x + width / 2, y - depth / 2, y + depth / 2
    return [(x0, y0, x1, y0), (x1, y0, x1, y1), (x1, y1, x0, y1), (x0, y1, x0, y0)]


class Driver:
    """Obeys velocities exactly, except where the body would enter something; a little noise on the odometry."""

    def __init__(self, site: Site, start_m: tuple[float, float] = (1.0, 1.0), noise_m: float = 0.004) -> None:
        self.walls: list[Segment] = [(*wall.start_m, *wall.end_m) for wall in site.wall]
        self.x, self.y, self.yaw = *start_m, 0.0
        self.boxes: list[Segment] = []
        self.contacts = 0
        self.nearest_m = 9.0
        self.velocity = VelocityCommand(robot="dog-1", seq=0, forward_mps=0.0, left_mps=0.0, yaw_rate_radps=0.0)
        self.speeds: list[float] = []
        self.grips: list[GripperCommand] = []
        self._random, self._noise_m, self._seq, self._touch = Random(7), noise_m, 0, False

    def start(self, node: Node) -> None:
        self.node = node
        node.subscribe("velocity")
        node.subscribe("gripper_command")

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        for event in events:
            if isinstance(event, Received) and isinstance(event.message, VelocityCommand):
                self.velocity = event.message
            if isinstance(event, Received) and isinstance(event.message, GripperCommand):
                self.grips.append(event.message)
        self._move(0.05)
        self._seq += 1
        noise = [self._random.gauss(0.0, self._noise_m) for _ in range(3)]
        odometry = Odometry(
            robot="dog-1",
            seq=self._seq,
            stamp_s=now_s,
            position_enu_m=(self.x + noise[0], self.y + noise[1], 0.0),
            yaw_rad=self.yaw + noise[2],
            speed_mps=abs(self.velocity.forward_mps),
            yaw_rate_radps=self.velocity.yaw_rate_radps,
            in_contact=self._touch,
        )
        self.node.publish("odometry", odometry, "dog-1")
        if self._seq % 4 == 1:
            self.node.publish("scan", self._scan(now_s, odometry), "dog-1")
        self.grip(now_s)

    def stop(self) -> None:
        pass

    def grip(self, now_s: float) -> None:
        """Answer the gripper commands that came."""
        for command in self.grips:
            state = GripperState(
                robot="dog-1",
                seq=self._seq,
                stamp_s=now_s,
                holding=False,
                command_id=command.command_id,
                ok=False,
                reason="nothing there",
            )
            self.node.publish("gripper_state", state, "dog-1")
        self.grips.clear()

    def gap_m(self, x: float, y: float) -> float:
        """From a point to the nearest wall (0.1 m thick) or box."""
        walls = _gaps(np.array(self.walls), x, y).min() - 0.05
        return float(min(walls, _gaps(np.array(self.boxes), x, y).min())) if self.boxes else float(walls)

    def _move(self, step_s: float) -> None:
        forward, turn = self.velocity.forward_mps, self.velocity.yaw_rate_radps
        self.speeds.append(abs(forward) + abs(turn))
        self.yaw += turn * step_s
        x, y = self.x + forward * step_s * cos(self.yaw), self.y + forward * step_s * sin(self.yaw)
        # The body is 0.35 m wide and 0.65 m long: its corners sweep RADIUS_M, its flanks half of that.
        self._touch = self.gap_m(x, y) < 0.18 or self.gap_m(x + 0.2 * cos(self.yaw), y + 0.2 * sin(self.yaw)) < 0.17
        self.contacts += self._touch
        if not self._touch:
            self.x, self.y = x, y
        self.nearest_m = min(self.nearest_m, self.gap_m(self.x, self.y))

    def _scan(self, now_s: float, odometry: Odometry) -> LaserScan:
        step = 2.0 * np.pi / BEAMS
        angles = self.yaw - np.pi + step * np.arange(BEAMS)
        segments = np.array(self.walls + self.boxes)
        ray = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        along = segments[:, 2:] - segments[:, :2]
        away = segments[:, :2] - (self.x, self.y)
        cross = ray[:, None, 0] * along[None, :, 1] - ray[:, None, 1] * along[None, :, 0]
        cross = np.where(np.abs(cross) < 1e-9, 1e-9, cross)
        distance = (away[:, 0] * along[:, 1] - away[:, 1] * along[:, 0])[None, :] / cross
        share = (away[None, :, 0] * ray[:, None, 1] - away[None, :, 1] * ray[:, None, 0]) / cross
        hit = np.where((distance > 0.0) & (share >= 0.0) & (share <= 1.0), distance, np.inf).min(axis=1)
        return LaserScan(
            robot="dog-1",
            seq=self._seq,
            stamp_s=now_s,
            position_enu_m=odometry.position_enu_m,
            yaw_rad=odometry.yaw_rad,
            angle_min_rad=-np.pi,
            angle_step_rad=step,
            range_max_m=RANGE_M,
            ranges_m=tuple(float(r) if r < RANGE_M else 0.0 for r in hit),
        )


def _gaps(segments: np.ndarray, x: float, y: float) -> np.ndarray:
    start, along = segments[:, :2], segments[:, 2:] - segments[:, :2]
    t = np.clip((((x, y) - start) * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
    nearest = start + t[:, None] * along
    return np.hypot(nearest[:, 0] - x, nearest[:, 1] - y)


class Hub:
    """Sends what a test tells it to and remembers what comes back."""

    def __init__(self) -> None:
        self.results: list[Result] = []
        self.acks: list[CommandAck] = []
        self.goals: list[GoalsReply] = []
        self.reports: list = []
        self.others_m: tuple[tuple[float, float], ...] = ()
        self.go, self.step_aside_m, self.silent = True, None, False
        self.to_ask: list[tuple[str, Command | CancelRequest | GoalsRequest]] = []
        self._seq = 0

    def start(self, node: Node) -> None:
        self.node = node
        node.subscribe("result")
        node.subscribe("robot_report")

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        for event in events:
            if isinstance(event, Received) and isinstance(event.message, Result):
                self.results.append(event.message)
            elif isinstance(event, Received):
                self.reports.append(event.message)
            elif isinstance(event, Reply) and isinstance(event.message, CommandAck):
                self.acks.append(event.message)
            elif isinstance(event, Reply) and isinstance(event.message, GoalsReply):
                self.goals.append(event.message)
        for service, message in self.to_ask:
            self.node.ask(service, message, "dog-1")
        self.to_ask.clear()
        self._seq += 1
        if self._seq % 2 == 0 and not self.silent:
            order = TrafficOrder(
                robot="dog-1",
                seq=self._seq,
                stamp_s=now_s,
                go=self.go,
                step_aside_m=self.step_aside_m,
                others_m=self.others_m,
            )
            self.node.publish("traffic", order, "dog-1")

    def stop(self) -> None:
        pass

    def send(self, command: Command) -> None:
        self.to_ask.append(("goal", command))


def command(goal_id: str, **fields: object) -> Command:
    """A goto unless the fields say otherwise."""
    given = {"epoch": 1, "robot": "dog-1", "action": "goto", "valid_until_s": 1e6, "timeout_s": 60.0, **fields}
    return Command.model_validate({"goal_id": goal_id, **given})


def away_m(driver: Driver, point_m: tuple[float, float]) -> float:
    return hypot(driver.x - point_m[0], driver.y - point_m[1])
