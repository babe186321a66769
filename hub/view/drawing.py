"""Draws messages: one method per topic, each at most as often as a person can use it."""

import rerun as rr

from hub.view.blueprint import TIMELINE
from hub.view.house import heading_arrow, place_camera
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
_ROBOT_RGB = ((255, 150, 30), (40, 160, 255), (210, 80, 220), (60, 200, 120), (240, 220, 60), (250, 90, 90))
_PICTURE_EVERY_S = 0.5
_STALE_AFTER_S = 60.0


class Drawing:
    """Keeps what must be drawn together (all objects are one batch) and when each thing was last drawn."""

    def __init__(self, rec: rr.RecordingStream) -> None:
        self._rec = rec
        self._objects: dict[str, ObjectState] = {}
        self._trails: dict[str, list[tuple[float, float, float]]] = {}
        self._doing: dict[str, str] = {}
        self._robots: set[str] = set()
        self._drawn_s: dict[str, float] = {}
        self._logged: dict[str, int] = {}

    def at(self, now_s: float) -> None:
        self._rec.set_time(TIMELINE, duration=now_s)

    def _due(self, entity: str, now_s: float, every_s: float) -> bool:
        if now_s - self._drawn_s.get(entity, -1e9) < every_s:
            return False
        self._drawn_s[entity] = now_s
        return True

    def frame(self, frame: CameraFrame) -> None:
        if not self._due(f"picture/{frame.camera}", frame.stamp_s, _PICTURE_EVERY_S):
            return
        self.at(frame.stamp_s)
        path = f"world/cameras/{frame.camera}/picture"
        if frame.depth_mm is not None:  # a camera that measures depth rides on a robot
            place_camera(self._rec, frame.camera, frame.position_enu_m, frame.yaw_rad, frame.tilt_down_rad)
            self._rec.log(
                path,
                rr.Pinhole(
                    resolution=[frame.width_px, frame.height_px], focal_length=frame.focal_px,
                    camera_xyz=rr.ViewCoordinates.RDF, image_plane_distance=0.4,
                ),
            )  # fmt: skip
        self._rec.log(path, rr.EncodedImage(contents=frame.jpeg, media_type="image/jpeg"))

    def observation(self, batch: ObservationBatch) -> None:
        boxes = [(o, o.box_px) for o in batch.objects if o.box_px is not None]
        self.at(batch.stamp_s)
        self._rec.log(
            f"world/cameras/{batch.source}/picture/seen",
            rr.Boxes2D(
                mins=[(b[0], b[1]) for _, b in boxes],
                sizes=[(b[2] - b[0], b[3] - b[1]) for _, b in boxes],
                labels=[f"{o.type} {o.confidence:.2f}" for o, _ in boxes],
                colors=[(90, 230, 120)] * len(boxes),
            ),
        )
        if batch.view is not None and self._due(f"view/{batch.source}", batch.stamp_s, 1.0):
            ring = [(x, y, 0.03) for x, y in (*batch.view.polygon_m, *batch.view.polygon_m[:1])]
            self._rec.log(f"world/views/{batch.source}", rr.LineStrips3D([ring], colors=[(120, 200, 255, 120)]))

    def report(self, report: RobotReport) -> None:
        if not self._due(f"robot/{report.robot}", report.stamp_s, 0.1):
            return
        self.at(report.stamp_s)
        path, rgb = f"world/robots/{report.robot}", self._robot_rgb(report.robot)
        x, y, z = report.position_enu_m
        turn = rr.RotationAxisAngle(axis=[0, 0, 1], radians=report.yaw_rad)
        self._rec.log(
            path,
            rr.Boxes3D(
                centers=[(x, y, z + 0.28), (x, y, z + 0.88)],
                half_sizes=[(0.32, 0.17, 0.16), (0.03, 0.03, 0.42)],
                rotation_axis_angles=[turn, turn],
                colors=[rgb, (60, 60, 60)],
                labels=[report.robot, ""],
                fill_mode="solid",
            ),
        )
        nose = heading_arrow(report.yaw_rad, 0.55)
        self._rec.log(f"{path}/heading", rr.Arrows3D(origins=[(x, y, z + 0.45)], vectors=[nose], colors=[rgb]))
        ahead = [(x, y, 0.05), *((px, py, 0.05) for px, py in report.path_m)]
        self._rec.log(f"{path}/path", rr.LineStrips3D([ahead], colors=[rgb], radii=0.02))
        self._trail(report.robot, (x, y, 0.04), report.stamp_s, rgb)
        self._rec.log(f"metrics/travelled_m/{report.robot}", rr.Scalars(report.travelled_m))

    def _trail(self, robot: str, point: tuple[float, float, float], now_s: float, rgb: tuple[int, int, int]) -> None:
        trail = self._trails.setdefault(robot, [])
        if not trail or max(abs(point[0] - trail[-1][0]), abs(point[1] - trail[-1][1])) > 0.1:
            trail.append(point)
        if self._due(f"trail/{robot}", now_s, 2.0):
            faded = (*rgb, 110)
            self._rec.log(f"world/trails/{robot}", rr.LineStrips3D([trail], colors=[faded], radii=0.015))

    def _robot_rgb(self, robot: str) -> tuple[int, int, int]:
        self._trails.setdefault(robot, [])
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
                self._show_doing(robot.id, robot.status)
        for area in delta.areas:
            self._rec.log(f"metrics/seen/{area.id}", rr.Scalars(area.seen_fraction))
        if self._due("objects", delta.stamp_s, 0.5):
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
        self._rec.log("metrics/objects_believed", rr.Scalars(float(len(known))))

    def _show_doing(self, robot: str, doing: str) -> None:
        if self._doing.get(robot) != doing:
            self._doing[robot] = doing
            self._rec.log(f"tasks/{robot}", rr.StateChange(state=doing))

    def plan(self, state: PlanState) -> None:
        self.at(state.stamp_s)
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
        self._rec.log("metrics/replans", rr.Scalars(float(state.replans)))
        labels = {n.id: self._node_label(n) for n in nodes}
        running = {n.robot: labels[n.id] for n in state.nodes if n.status == "running" and n.robot is not None}
        for robot in sorted(self._robots):
            self._show_doing(robot, running.get(robot, "idle"))

    def _node_label(self, node: PlanNode) -> str:
        thing = self._objects.get(node.object or "")
        return f"{node.action} {thing.type if thing else node.room or node.object or ''}"

    def task(self, state: TaskState) -> None:
        self.at(state.stamp_s)
        goals = "\n".join(f"- {'✔' if g.holds else '·'} {g.goal.text or g.goal.predicate}" for g in state.goals)
        text = (
            f"### {state.instruction}\n\n**{state.status}** {state.reason}\n\n{goals}\n\n"
            f"planner {state.planner or '-'}, steps {state.nodes_done}/{state.nodes_total}, replans {state.replans}, "
            f"{state.path_m:.0f} m, {state.action_steps} action steps"
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
