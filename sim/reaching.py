"""Which thing a gripper that reaches to a point gets hold of, and whether the arm and the eye get there."""

from collections.abc import Sequence
from dataclasses import dataclass

from sim.boxes import Box, body_box
from sim.scene import Body, Scene, Vec2, Vec3
from sim.sight import ancestors, closed_around, contents, hides_contents, is_visible, obstacles_around
from wire.catalogue import catalogue
from wire.messages.driver import GripperAction

REACH_M = 1.2
"""From the body's centre to the nearest point of the thing, in the floor plane."""
SIGHT_M = 3.0
"""Nothing that hides a thing in reach is farther than this."""
POINT_TOLERANCE_M = 0.30
"""A thing within this of the point is what was meant."""

FLAG: dict[GripperAction, str] = {
    "pickup": "pickupable",
    "put": "receptacle",
    "open": "openable",
    "close": "openable",
    "toggle_on": "toggleable",
    "toggle_off": "toggleable",
    "slice": "sliceable",
    "clean": "dirtyable",
}
DOING: dict[GripperAction, str] = {
    "pickup": "be picked up",
    "put": "hold anything",
    "open": "be opened",
    "close": "be closed",
    "toggle_on": "be switched on",
    "toggle_off": "be switched off",
    "slice": "be sliced",
    "clean": "be cleaned",
}


class Refused(Exception):
    """The gripper cannot do it; the text is the reason, for people."""


@dataclass(frozen=True)
class Stance:
    """Where a robot stands with its arm: body centre on the floor, mast camera, and the other robots' bodies."""

    robot: str
    centre_m: Vec2
    eye_m: Vec3
    others: tuple[Box, ...]
    structure: Sequence[Box]


def resolve(scene: Scene, action: GripperAction, point_m: Vec3, expected_type: str | None, held: int | None) -> Body:
    """The thing at the point; Refused when there is none that fits."""
    out_of_play = {held, *contents(scene, held)} if held is not None else set()
    near = [
        (body_box(body).gap_m(point_m), body)
        for key, body in scene.bodies.items()
        if not body.gone and body.held_by is None and key not in out_of_play
    ]
    near = [(gap_m, body) for gap_m, body in near if gap_m <= POINT_TOLERANCE_M and _is_free(scene, body.key)]
    ranked = sorted(near, key=lambda row: _rank(action, point_m, expected_type, *row))
    if not ranked:
        raise Refused(f"there is nothing within {POINT_TOLERANCE_M:.1f} m of the point")
    best = ranked[0][1]
    if expected_type is not None and best.type != expected_type:
        for gap_m, body in ranked:
            if gap_m == 0.0 and hides_contents(body):
                raise Refused(f"the {body.type} is closed and in the way; open it first")
        raise Refused(f"there is no {expected_type} at the point, but a {best.type}")
    if not catalogue()[best.type].can(FLAG[action]):
        raise Refused(f"a {best.type} cannot {DOING[action]}")
    return best


def _is_free(scene: Scene, key: int) -> bool:
    """Neither shut up in something nor in something that a hand carries."""
    carried = any(scene.bodies[around].held_by is not None for around in ancestors(scene, key))
    return not carried and closed_around(scene, key) is None


def _rank(
    action: GripperAction, point_m: Vec3, expected_type: str | None, gap_m: float, body: Body
) -> tuple[bool, bool, float, float, int]:
    """The expected type first, then what the action can be done to, then the nearest."""
    box = body_box(body)
    off_m = sum((a - b) ** 2 for a, b in zip(box.centre_m, point_m, strict=True))
    unable = not catalogue()[body.type].can(FLAG[action])
    return (expected_type is not None and body.type != expected_type, unable, gap_m, off_m, body.key)


def check_reach(scene: Scene, stance: Stance, target: Body) -> None:
    """Refused when the arm is too short or the mast camera does not see the thing."""
    away_m = body_box(target).floor_gap_m(stance.centre_m)
    if away_m > REACH_M:
        raise Refused(f"the {target.type} is out of reach: {away_m:.2f} m away, the arm reaches {REACH_M:.2f} m")
    around = obstacles_around(scene, stance.structure, stance.others, stance.eye_m, SIGHT_M)
    if not is_visible(scene, around, stance.eye_m, target.key):
        raise Refused(f"the {target.type} is out of sight: something blocks the view of it")
