"""The world as it is, in the words of the fused world state: for the evaluator alone."""

from collections.abc import Iterable, Mapping

from sim.boxes import body_box
from sim.rover import Motion
from sim.scene import Body, Scene, Vec2
from wire.frames import yaw_deg
from wire.messages.world import AreaState, ObjectState, PropertyState, RobotState, WorldState

SOURCE = "sim"


def inside(polygon_m: tuple[Vec2, ...], point_m: Vec2) -> bool:
    """Whether a floor point lies in a polygon (crossing number)."""
    x, y = point_m
    odd = False
    for (ax, ay), (bx, by) in zip(polygon_m, (*polygon_m[1:], polygon_m[0]), strict=True):
        if (ay > y) != (by > y) and x < ax + (y - ay) * (bx - ax) / (by - ay):
            odd = not odd
    return odd


def room_of(scene: Scene, point_m: Vec2) -> str | None:
    """The room that a floor point is in; None in a doorway or outside."""
    return next((room.id for room in scene.rooms if inside(room.polygon_m, point_m)), None)


def true_world(
    scene: Scene,
    robots: Mapping[str, Motion],
    visited: Iterable[str],
    verified: Iterable[int],
    now_s: float,
    seq: int,
) -> WorldState:
    """Everything there is. `visited` are rooms a robot has been in, `verified` things a robot has seen from near."""
    rooms, near = set(visited), set(verified)
    hands = {body.held_by: body.key for body in scene.bodies.values() if body.held_by is not None}
    return WorldState(
        seq=seq,
        stamp_s=now_s,
        robots=tuple(_robot(scene, id, motion, hands.get(id), now_s) for id, motion in robots.items()),
        objects=tuple(_object(scene, b, b.key in near, now_s) for b in scene.bodies.values() if not b.gone),
        areas=tuple(
            AreaState(
                id=room.id,
                name=room.name,
                kind=room.kind,
                seen_fraction=1.0 if room.id in rooms else 0.0,
                camera_fraction=0.0,
                stamp_s=now_s,
                source=SOURCE,
                searched=room.id in rooms,
            )
            for room in scene.rooms
        ),
    )


def true_id(key: int) -> str:
    return f"t-{key}"


def _robot(scene: Scene, id: str, motion: Motion, held: int | None, now_s: float) -> RobotState:
    return RobotState(
        id=id,
        kind="quadruped",
        position_enu_m=(*motion.position_m, 0.0),
        yaw_deg=yaw_deg(motion.yaw_rad),
        status="executing" if motion.speed_mps > 0.01 or abs(motion.yaw_rate_radps) > 0.01 else "idle",
        inventory=None if held is None else true_id(held),
        stamp_s=now_s,
        room=room_of(scene, motion.position_m),
    )


def _object(scene: Scene, body: Body, verified: bool, now_s: float) -> ObjectState:
    centre_m = body_box(body).centre_m
    around = body.held_by if body.parent is None else true_id(body.parent)
    return ObjectState(
        id=true_id(body.key),
        type=body.type,
        position_enu_m=centre_m,
        covariance_m2=(0.0, 0.0, 0.0, 0.0),
        receptacle=around,
        props={
            name: PropertyState(value=value, confidence=1.0, source=SOURCE, stamp_s=now_s)
            for name, value in body.props.items()
        },
        room=room_of(scene, (centre_m[0], centre_m[1])),
        source=SOURCE,
        stamp_s=now_s,
        confidence=1.0,
        verified=verified,
    )
