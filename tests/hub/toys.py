"""Little processes for the hub's loopback tests: a robot that walks as the crow flies through doors, a list of plans."""

from collections.abc import Callable, Sequence
from math import atan2, hypot

from hub.distance import Distances
from hub.floor import FloorPlan
from tests.hub.scenes import card
from wire.bus import Event, Node, Received, Request
from wire.messages.command import (
    CancelRequest,
    CardRequest,
    Command,
    CommandAck,
    GoalRecord,
    GoalsReply,
    GoalsRequest,
    Result,
    RobotReport,
    TrafficOrder,
)
from wire.messages.observation import Absence, ObjectObservation, ObservationBatch
from wire.messages.plan import PlanReply, PlanRequest
from wire.model import Vec2
from wire.site import Site

STEP_M = 0.03
WORK_S = 1.0


def way(site: Site, start: Vec2, end: Vec2) -> list[Vec2]:
    """Through the doors, straight, entering each door squarely."""
    plan = FloorPlan(site)
    distances = Distances(plan)
    points, here = [], start
    while plan.room_at(*here) != plan.room_at(*end):
        room = plan.room_at(*here)
        doors = [d for d in plan.doors if room in d.rooms]
        door = min(
            doors,
            key=lambda d: distances.walk_m(d.middle_m, end) + hypot(here[0] - d.middle_m[0], here[1] - d.middle_m[1]),
        )
        sides = [tuple(m + k * 0.7 * n for m, n in zip(door.middle_m, door.normal, strict=True)) for k in (1, -1)]
        sides.sort(key=lambda p: plan.room_at(*p) != room)
        points += sides
        here = sides[-1]
    return [*points, end]


class ToyRobot:
    """Walks to where the target is, works a second, says done. `fail`: may turn a command into a failure code."""

    def __init__(self, site: Site, id: str, at: Vec2, fail: Callable[[Command], str | None] = lambda c: None) -> None:
        self.site, self.id, self.xy, self.fail = site, id, at, fail
        self.path: list[Vec2] = []
        self.command: Command | None = None
        self.work_s = 0.0
        self.order: TrafficOrder | None = None
        self.records: dict[str, GoalRecord] = {}
        self.results: list[Result] = []
        self.holding = False
        self.holding_type: str | None = None
        self.deaf = False
        """It does not hear when it is told to stop."""
        self.walked = 0.0
        self.seq = 0
        self.epoch = 0

    def start(self, node: Node) -> None:
        self.node = node
        for service in ("card", "goal", "cancel", "goals"):
            node.serve(service, self.id)
        node.subscribe("traffic", self.id)

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        for event in events:
            if isinstance(event, Received) and isinstance(event.message, TrafficOrder):
                self.order = event.message
            elif isinstance(event, Request):
                event.reply(self._answer(event.message, now_s))
        self._move(now_s)
        self._report(now_s)

    def stop(self) -> None: ...

    def _answer(self, message, now_s: float):
        if isinstance(message, CardRequest):
            return card(self.id)
        if isinstance(message, GoalsRequest):
            return GoalsReply(robot=self.id, boot_id="b", epoch=self.epoch, goals=tuple(self.records.values()))
        if isinstance(message, CancelRequest):
            if self.command is not None and not self.deaf and message.goal_id in (None, self.command.goal_id):
                self._end("cancelled", "cancelled", now_s)
            return CommandAck(goal_id=message.goal_id or "", accepted=True)
        assert isinstance(message, Command)
        if message.goal_id in self.records:
            return CommandAck(goal_id=message.goal_id, accepted=True, status=self.records[message.goal_id].status)
        if self.command is not None:
            return CommandAck(goal_id=message.goal_id, accepted=False, reason="busy")
        self.epoch = message.epoch
        self.command = message
        self.records[message.goal_id] = GoalRecord(goal_id=message.goal_id, status="running")
        self.work_s = WORK_S
        self.path = way(self.site, self.xy, self._goal(message))
        return CommandAck(goal_id=message.goal_id, accepted=True, status="running")

    def _goal(self, command: Command) -> Vec2:
        if command.target is None:
            if command.point_m is not None:
                return command.point_m
            polygon = next(r.polygon_m for r in self.site.room if r.id == command.room)
            return (sum(p[0] for p in polygon) / len(polygon), sum(p[1] for p in polygon) / len(polygon))
        x, y, _ = command.target.position_enu_m
        room = FloorPlan(self.site).polygons[command.target.room or "kitchen"]
        cx, cy = sum(p[0] for p in room) / len(room), sum(p[1] for p in room) / len(room)
        away = hypot(cx - x, cy - y)
        share = min(1.0, 0.8 / away) if away else 0.0
        return (x + share * (cx - x), y + share * (cy - y))

    def _move(self, now_s: float) -> None:
        order = self.order
        if order is not None and order.step_aside_m is not None:
            self._walk([order.step_aside_m])
            if self.command is not None:
                self.path = way(self.site, self.xy, self._goal(self.command))
            return
        if order is not None and not order.go:
            return
        if self.path:
            self._walk(self.path)
        elif self.command is not None:
            self.work_s -= 0.05
            if self.work_s <= 0.0:
                code = self.fail(self.command)
                self._end("failed" if code else "done", code or "ok", now_s)

    def _walk(self, path: list[Vec2]) -> None:
        x, y = path[0]
        gap = hypot(x - self.xy[0], y - self.xy[1])
        step = min(gap, STEP_M)
        self.walked += step
        if gap <= STEP_M:
            self.xy = (x, y)
            path.pop(0)
        else:
            self.xy = (self.xy[0] + (x - self.xy[0]) * step / gap, self.xy[1] + (y - self.xy[1]) * step / gap)

    def _end(self, status: str, code: str, now_s: float) -> None:
        command, self.command, self.path = self.command, None, []
        assert command is not None
        point = None
        if status == "done":
            self.holding = {"pickup": True, "put": False}.get(command.action, self.holding)
            point = command.target.position_enu_m if command.target is not None else None
        self.records[command.goal_id] = GoalRecord(goal_id=command.goal_id, status=status, code=code, point_enu_m=point)
        result = Result(
            goal_id=command.goal_id,
            robot=self.id,
            stamp_s=now_s,
            status=status,
            code=code,
            reason=code,
            point_enu_m=point,
            holding=self.holding,
        )
        self.results.append(result)
        self.node.publish("result", result, self.id)

    def _report(self, now_s: float) -> None:
        self.seq += 1
        report = RobotReport(
            robot=self.id,
            seq=self.seq,
            stamp_s=now_s,
            position_enu_m=(*self.xy, 0.3),
            yaw_rad=atan2(self.path[0][1] - self.xy[1], self.path[0][0] - self.xy[0]) if self.path else 0.0,
            status="executing" if self.command else "idle",
            holding=self.holding,
            holding_type=self.holding_type if self.holding else None,
            goal_id=self.command.goal_id if self.command else None,
            path_m=tuple(self.path),
            travelled_m=self.walked,
        )
        self.node.publish("robot_report", report, self.id)


class ToyCamera:
    """Publishes what a function says is to be seen, twice a second."""

    def __init__(self, source: str, look: Callable[[float], Sequence[ObjectObservation]]) -> None:
        self.source, self.look, self.seq = source, look, 0
        self.gone: Callable[[float], Sequence[Absence]] = lambda now_s: ()

    def start(self, node: Node) -> None:
        self.node = node

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        if self.seq > 2 * now_s:
            return
        self.seq += 1
        picture = ObservationBatch(
            source=self.source,
            boot_id="b",
            seq=self.seq,
            stamp_s=now_s,
            kind="cctv",
            objects=tuple(self.look(now_s)),
            gone=tuple(self.gone(now_s)),
        )
        self.node.publish("observation", picture, self.source)

    def stop(self) -> None: ...


class ToyPlanner:
    """Answers with what a function makes of the request."""

    def __init__(self, answer: Callable[[PlanRequest], PlanReply]) -> None:
        self.answer = answer
        self.requests: list[PlanRequest] = []

    def start(self, node: Node) -> None:
        node.serve("make_plan")

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        for event in events:
            if isinstance(event, Request) and isinstance(event.message, PlanRequest):
                self.requests.append(event.message)
                event.reply(self.answer(event.message))

    def stop(self) -> None: ...
