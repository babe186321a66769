"""Draws messages: one method per topic, each at most as often as a person can use it, and only what is new."""

from collections import deque
from collections.abc import Collection
from math import inf

import rerun as rr

from hub.view.blueprint import TIMELINE
from hub.view.flying import draw_flight, draw_quadrotor, way_ahead
from hub.view.house import draw_robot, place_camera, place_lens
from wire.costs import cost_text, planner_text
from wire.messages.command import RobotReport
from wire.messages.driver import CameraFrame
from wire.messages.observation import EventLog, ObservationBatch
from wire.messages.operator import TaskState
from wire.messages.plan import PlanNode, PlanState
from wire.messages.world import ObjectState, WorldDelta

_NODE_RGB = {
    "pending": (140, 140, 140),
    "running": (240, 180, 40),
    "done": (60, 180, 90),
    "failed": (220, 60, 60),
    "cancelled": (110, 80, 120),
}
_DOING = {"holding": "gives way", "canceling": "stopping"}
"""A robot's status in words; `holding` would be taken for something in its hand."""
_ROBOT_RGB = ((255, 150, 30), (40, 160, 255), (210, 80, 220), (60, 200, 120), (240, 220, 60), (250, 90, 90))
_BOX_RGB = (90, 230, 120)
_PICTURE_EVERY_S = 0.5
_ROBOT_EVERY_S, _PATH_EVERY_S = 0.2, 0.5
_STALE_AFTER_S = 60.0
_AGAIN_S = 10.0
"""What stays the same is drawn again this often: the server lets the oldest go, and a browser may join late."""
_TRAIL_POINTS = 1000
"""Of the way that a robot came: some hundred metres."""


class Drawing:
    """Keeps what must be drawn together (all objects are one batch), and what was drawn last and when."""

    def __init__(self, rec: rr.RecordingStream, flyers: Collection[str] = ()) -> None:
        self._rec, self._flyers = rec, frozenset(flyers)
        self._objects: dict[str, ObjectState] = {}
        self._trails: dict[str, deque[tuple[float, float, float]]] = {}
        self._doing: dict[str, str] = {}
        self._robots: set[str] = set()
        self._drawn_s: dict[str, float] = {}
        self._shown: dict[str, object] = {}
        self._plan: PlanState | None = None
        self._task: TaskState | None = None

    def at(self, now_s: float) -> None:
        self._rec.set_time(TIMELINE, duration=now_s)

    def _due(self, entity: str, now_s: float, every_s: float) -> bool:
        """A clock that was set back, as by a simulator that starts anew, makes everything due."""
        if 0.0 <= now_s - self._drawn_s.get(entity, -inf) < every_s:
            return False
        self._drawn_s[entity] = now_s
        return True

    def _news(self, entity: str, now_s: float, value: object) -> bool:
        """Whether this differs from what was drawn last, or that is long ago."""
        if self._shown.get(entity) == value and not self._due(entity, now_s, _AGAIN_S):
            return False
        self._shown[entity], self._drawn_s[entity] = value, now_s
        return True

    def again(self, now_s: float) -> None:
        """What is told but once, for those who join late."""
        if self._due("again", now_s, _AGAIN_S):
            self.at(now_s)
            if self._plan is not None:
                self._draw_plan(self._plan)
            if self._task is not None:
                self._draw_task(self._task)

    def frame(self, frame: CameraFrame) -> None:
        if not self._due(f"picture/{frame.camera}", frame.stamp_s, _PICTURE_EVERY_S):
            return
        self.at(frame.stamp_s)
        path = f"world/cameras/{frame.camera}/picture"
        if frame.depth_mm is not None or self.flies(frame.camera):  # a camera that measures depth rides on a robot
            self._place(frame, path)
        if self._news(path, frame.stamp_s, frame.jpeg):
            self._rec.log(path, rr.EncodedImage(contents=frame.jpeg, media_type="image/jpeg"))

    def flies(self, camera: str) -> bool:
        """Whether a camera is one of a drone's: called like it, with a word of its own after that if it has several."""
        return any(camera == flyer or camera.startswith(f"{flyer}-") for flyer in self._flyers)

    def _place(self, frame: CameraFrame, path: str) -> None:
        pose = (frame.position_enu_m, frame.yaw_rad, frame.tilt_down_rad)
        if self._news(f"pose/{frame.camera}", frame.stamp_s, pose):
            place_camera(self._rec, frame.camera, *pose)
        lens = (frame.width_px, frame.height_px, frame.focal_px)
        if self._shown.get(f"lens/{frame.camera}") != lens:
            self._shown[f"lens/{frame.camera}"] = lens
            place_lens(self._rec, frame.camera, *lens, plane_m=0.4)

    def observation(self, batch: ObservationBatch) -> None:
        boxes = [(o.box_px, o.type) for o in batch.objects if o.box_px is not None]
        self.at(batch.stamp_s)
        path = f"world/cameras/{batch.source}/picture/seen"
        if self._news(path, batch.stamp_s, boxes):
            self._rec.log(
                path,
                rr.Boxes2D(
                    mins=[(b[0], b[1]) for b, _ in boxes],
                    sizes=[(b[2] - b[0], b[3] - b[1]) for b, _ in boxes],
                    labels=[label for _, label in boxes],
                    colors=_BOX_RGB,
                ),
            )
        view = f"world/views/{batch.source}"
        if batch.view is not None and self._news(view, batch.stamp_s, batch.view.polygon_m):
            ring = [(x, y, 0.03) for x, y in (*batch.view.polygon_m, *batch.view.polygon_m[:1])]
            self._rec.log(view, rr.LineStrips3D([ring], colors=[(120, 200, 255, 120)]))

    def report(self, report: RobotReport) -> None:
        if not self._due(f"report/{report.robot}", report.stamp_s, _ROBOT_EVERY_S):
            return
        self.at(report.stamp_s)
        if report.robot not in self._trails:
            self._trails[report.robot] = deque(maxlen=_TRAIL_POINTS)
            draw_body = draw_quadrotor if report.robot in self._flyers else draw_robot
            draw_body(self._rec, report.robot, self._robot_rgb(report.robot))
        path, rgb = f"world/robots/{report.robot}", self._robot_rgb(report.robot)
        position_m, yaw_rad = report.position_enu_m, report.yaw_rad
        if self._news(path, report.stamp_s, (position_m, yaw_rad)):
            turn = rr.RotationAxisAngle(axis=[0, 0, 1], radians=yaw_rad)
            self._rec.log(path, rr.Transform3D(translation=position_m, rotation_axis_angle=turn))
        x, y, z = position_m
        if self._due(f"path/{report.robot}", report.stamp_s, _PATH_EVERY_S):
            ahead = way_ahead(report)
            if self._news(f"world/paths/{report.robot}", report.stamp_s, ahead):
                self._rec.log(f"world/paths/{report.robot}", rr.LineStrips3D([ahead], colors=[rgb], radii=0.02))
        flies = report.robot in self._flyers
        self._trail(report.robot, (x, y, z if flies else 0.04), report.stamp_s, rgb)
        if flies and self._due(f"flight/{report.robot}", report.stamp_s, 1.0):
            draw_flight(self._rec, report)
        if self._due(f"travelled/{report.robot}", report.stamp_s, 1.0):
            self._rec.log(f"metrics/travelled_m/{report.robot}", rr.Scalars(report.travelled_m))

    def _trail(self, robot: str, point: tuple[float, float, float], now_s: float, rgb: tuple[int, int, int]) -> None:
        trail = self._trails[robot]
        if not trail or max(abs(a - b) for a, b in zip(point, trail[-1], strict=True)) > 0.1:
            trail.append(point)
        if self._due(f"trail/{robot}", now_s, 2.0) and self._news(f"world/trails/{robot}", now_s, trail[-1]):
            faded = (*rgb, 110)
            self._rec.log(f"world/trails/{robot}", rr.LineStrips3D([list(trail)], colors=[faded], radii=0.015))

    def _robot_rgb(self, robot: str) -> tuple[int, int, int]:
        return _ROBOT_RGB[list(self._trails).index(robot) % len(_ROBOT_RGB)]

    def world(self, delta: WorldDelta) -> None:
        for obj in delta.objects:
            self._objects[obj.id] = obj
        for gone in delta.removed:
            self._objects.pop(gone, None)
        self.at(delta.stamp_s)
        for robot in delta.robots:
            self._robots.add(robot.id)
            if robot.status not in ("executing", "idle"):
                self._show_doing(robot.id, _DOING.get(robot.status, robot.status))
        for area in delta.areas:
            if self._due(f"metrics/seen/{area.id}", delta.stamp_s, 1.0):
                self._rec.log(f"metrics/seen/{area.id}", rr.Scalars(area.seen_fraction))
        if self._due("objects", delta.stamp_s, 1.0):
            self._draw_objects(delta.stamp_s)

    def _draw_objects(self, now_s: float) -> None:
        known = list(self._objects.values())
        self._rec.log(
            "world/objects",
            rr.Points3D(
                [o.position_enu_m for o in known],
                radii=[0.09 if o.verified else 0.06 for o in known],
                colors=[_age_colour(now_s - o.stamp_s, o.confidence) for o in known],
                labels=[_label(o) for o in known],
                show_labels=False,
            ),
        )
        self._rec.log("metrics/counts/objects_believed", rr.Scalars(float(len(known))))

    def _show_doing(self, robot: str, doing: str) -> None:
        if self._doing.get(robot) != doing:
            self._doing[robot] = doing
            self._rec.log(f"tasks/{robot}", rr.StateChange(state=doing))

    def plan(self, state: PlanState) -> None:
        self._plan = state
        self.at(state.stamp_s)
        self._draw_plan(state)
        self._rec.log("metrics/counts/replans", rr.Scalars(float(state.replans)))
        labels = {n.id: self._node_label(n) for n in state.plan.nodes}
        running = {n.robot: labels[n.id] for n in state.nodes if n.status == "running" and n.robot is not None}
        for robot in sorted(self._robots):
            self._show_doing(robot, running.get(robot, "idle"))

    def _draw_plan(self, state: PlanState) -> None:
        status = {n.id: n.status for n in state.nodes}
        depth = _depths(state.plan.nodes)
        rows: dict[int, int] = {}
        positions = []
        for node in state.plan.nodes:
            column = depth[node.id]
            rows[column] = rows.get(column, -1) + 1
            positions.append((column * 190.0, rows[column] * 60.0))
        nodes = state.plan.nodes
        self._rec.log(
            "plan",
            rr.GraphNodes(
                node_ids=[n.id for n in nodes],
                labels=[self._node_label(n) for n in nodes],
                colors=[_NODE_RGB[status.get(n.id, "pending")] for n in nodes],
                positions=positions,
            ),
            rr.GraphEdges(edges=[(a, n.id) for n in nodes for a in n.after], graph_type="directed"),
        )

    def _node_label(self, node: PlanNode) -> str:
        thing = self._objects.get(node.object or "")
        return f"{node.action} {thing.type if thing else node.room or node.object or ''}"

    def task(self, state: TaskState) -> None:
        self._task = state
        self.at(state.stamp_s)
        self._draw_task(state)

    def _draw_task(self, state: TaskState) -> None:
        goals = "\n".join(f"- {'✔' if g.holds else '·'} {g.goal.text or g.goal.predicate}" for g in state.goals)
        cost = cost_text(state)
        text = (
            f"### {state.instruction}\n\n**{state.status}** {state.reason}\n\n{goals}\n\n"
            f"{planner_text(state)}, steps {state.nodes_done}/{state.nodes_total}, replans {state.replans}, "
            f"{state.path_m:.0f} m, {state.action_steps} action steps{f', {cost}' if cost else ''}"
        )
        self._rec.log("task", rr.TextDocument(text, media_type="text/markdown"))

    def event(self, event: EventLog) -> None:
        self.at(event.stamp_s)
        self._rec.log(f"log/{event.source}", rr.TextLog(event.text))


def _label(obj: ObjectState) -> str:
    props = " ".join(name.removeprefix("is").lower() for name, p in sorted(obj.props.items()) if p.value)
    return f"{obj.type} {props}".strip()


def _age_colour(age_s: float, confidence: float) -> tuple[int, int, int, int]:
    """Green when just seen, towards grey with age; faint when unsure."""
    fresh = max(0.0, 1.0 - age_s / _STALE_AFTER_S)
    return (int(130 - 90 * fresh), int(130 + 90 * fresh), 130, int(60 + 195 * confidence))


def _depths(nodes: tuple[PlanNode, ...]) -> dict[str, int]:
    """Column of each node: one more than the deepest it waits for. The hub has checked that there is no cycle."""
    by_id = {n.id: n for n in nodes}
    depth: dict[str, int] = {}

    def of(node_id: str) -> int:
        if node_id not in depth:
            depth[node_id] = 1 + max((of(a) for a in by_id[node_id].after if a in by_id), default=-1)
        return depth[node_id]

    for node in nodes:
        of(node.id)
    return depth
