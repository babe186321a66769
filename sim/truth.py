"""The world as it is, in the words of the fused world state: for the evaluator alone."""

from collections.abc import Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from types import MappingProxyType

from sim.boxes import body_box
from sim.rover import Motion
from sim.scene import Body, Room, Scene, Vec2, Vec3
from wire.frames import yaw_deg
from wire.messages.world import AreaState, ObjectState, PropertyState, RobotState, WorldState
from wire.outline import inside

SOURCE = "sim"


def room_of(scene: Scene, point_m: Vec2) -> str | None:
    """The room that a floor point is in; None in a doorway or outside."""
    return next((room.id for room in scene.rooms if inside(point_m, room.polygon_m)), None)


@dataclass(frozen=True)
class Above:
    """What drones have been over: rooms by id, things by key."""

    rooms: AbstractSet[str]
    surveyed: AbstractSet[str]
    things: AbstractSet[int]


NOTHING_ABOVE = Above(frozenset(), frozenset(), frozenset())


class Truth:
    """Makes world states. What has not changed since the last one is not made anew: its stamp is that of its change."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._made: dict[int, tuple[object, ObjectState]] = {}

    def world(
        self,
        robots: Mapping[str, Motion],
        visited: AbstractSet[str],
        verified: AbstractSet[int],
        now_s: float,
        seq: int,
        drones: Mapping[str, tuple[Vec3, float]] = MappingProxyType({}),
        above: Above = NOTHING_ABOVE,
    ) -> WorldState:
        """Everything there is. `visited` are rooms a robot has been in, `verified` things a robot has seen from near;
        `drones` are true poses."""
        bodies = self._scene.bodies.values()
        hands = {body.held_by: body.key for body in bodies if body.held_by is not None}
        return WorldState(
            seq=seq,
            stamp_s=now_s,
            robots=(
                *(_robot(self._scene, id, motion, hands.get(id), now_s) for id, motion in robots.items()),
                *(_drone(self._scene, id, pose, now_s) for id, pose in drones.items()),
            ),
            objects=tuple(
                self._object(b, b.key in verified, b.key in above.things, now_s) for b in bodies if not b.gone
            ),
            areas=tuple(_area(room, room.id in visited, above, now_s) for room in self._scene.rooms),
        )

    def _object(self, body: Body, verified: bool, above: bool, now_s: float) -> ObjectState:
        mark = (body.position_m, body.yaw_rad, body.parent, body.held_by, verified, above, tuple(body.props.items()))
        made = self._made.get(body.key)
        if made is None or made[0] != mark:
            made = (mark, _object(self._scene, body, verified, above, now_s))
            self._made[body.key] = made
        return made[1]


def true_id(key: int) -> str:
    return f"t-{key}"


def _area(room: Room, visited: bool, above: Above, now_s: float) -> AreaState:
    return AreaState(
        id=room.id,
        name=room.name,
        kind=room.kind,
        seen_fraction=1.0 if visited else 0.0,
        camera_fraction=0.0,
        stamp_s=now_s,
        source=SOURCE,
        searched=visited,
        seen_from_above=room.id in above.rooms,
        surveyed=room.id in above.surveyed,
    )


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


def _drone(scene: Scene, id: str, pose: tuple[Vec3, float], now_s: float) -> RobotState:
    place_m, yaw_rad = pose
    return RobotState(
        id=id,
        kind="drone",
        position_enu_m=place_m,
        yaw_deg=yaw_deg(yaw_rad),
        status="executing" if place_m[2] > 0.1 else "idle",
        stamp_s=now_s,
        room=room_of(scene, place_m[:2]),
        airborne=place_m[2] > 0.1,
    )


def _object(scene: Scene, body: Body, verified: bool, above: bool, now_s: float) -> ObjectState:
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
        seen_from_above=above,
    )
