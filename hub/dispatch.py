"""Ready nodes to idle robots, all at once: skill, walking distance, what is in the hand, wishes, camera horizon."""

from collections.abc import Sequence
from math import atan2, inf, pi

from hub.assignment import FORBIDDEN, assign
from hub.distance import Distances
from hub.fleet import Robot
from hub.floor import FloorPlan
from hub.kinds import BLADES
from hub.plan import PlanRun, Step
from hub.things import Things
from wire.frames import wrap_rad
from wire.messages.plan import FROM_ABOVE
from wire.model import Vec2, Vec3
from wire.outline import mean_m

_STOLEN_M = 6.0
"""A node that the planner gave to another robot costs this much more walking."""
_PATIENCE_S = 15.0
"""So long a node waits for its own robot to come free before anybody may take it."""
_OTHER_ERRAND_M = 5.0
"""A robot with something in its hand should bring that home first."""
_TURN_M_PER_RAD = 0.25
_TILT_M_PER_RAD = 0.1
_MAST_M = 1.3
_COMING_DOWN = ("land", "return_home", "hold")
"""What a drone does on its last charge, too."""
_HORIZON_RAD = 0.3
_MOST_READY = 64
_TAKE_OFF_M = 3.0
"""Getting up is as dear as this much way."""
_FROM_BELOW_M = 6.0
"""Looks from above are rather for those who fly."""
_ENDURANCE_S, _AT_WORK_S, _RESERVE = 480.0, 30.0, 0.2
"""A full battery is taken to keep a drone in the air so long until the drone knows better; a task there takes so long;
this much is left in the end."""
_USUAL_MPS = 0.8


class Dispatch:
    """Matches by the least total cost; the same inputs always give the same matching."""

    def __init__(self, floor: FloorPlan, things: Things) -> None:
        self._floor, self._things = floor, things
        self.distances = Distances(floor)

    def match(
        self, run: PlanRun, ready: Sequence[Step], robots: Sequence[Robot], busy: frozenset[str], now_s: float
    ) -> list[tuple[Step, Robot]]:
        """Who starts what now. `robots`: everybody present; `busy`: those who have a goal."""
        idle = sorted((r for r in robots if r.id not in busy and r.status == "idle"), key=lambda r: r.id)
        steps = list(ready)[:_MOST_READY]
        if not idle or not steps:
            return []
        present = frozenset(r.id for r in robots)
        table = [[self._cost(run, step, robot, present, busy, now_s) for step in steps] for robot in idle]
        return [(steps[column], robot) for robot, column in zip(idle, assign(table), strict=True) if column is not None]

    def _cost(
        self, run: PlanRun, step: Step, robot: Robot, present: frozenset[str], busy: frozenset[str], now_s: float
    ) -> float:
        node = step.node
        if not {node.action, *node.req_skills} <= set(robot.skills):
            return FORBIDDEN
        if not self._hands_suit(run, step, robot):
            return FORBIDDEN
        if self.short_of_power(step, robot):
            return FORBIDDEN
        cost = self._way(step, robot)
        if node.action in FROM_ABOVE and not robot.flies:
            cost += _FROM_BELOW_M
        preferred = node.preferred_robot
        if preferred is not None and preferred != robot.id and preferred in present and node.action != "put":
            waited_s = now_s - (step.ready_s if step.ready_s is not None else now_s)
            if preferred in busy and waited_s < _PATIENCE_S:
                return FORBIDDEN
            cost += _STOLEN_M
        if robot.full_handed and (node.item is None or node.item != robot.inventory):
            cost += _OTHER_ERRAND_M
        return min(cost, FORBIDDEN)

    def _hands_suit(self, run: PlanRun, step: Step, robot: Robot) -> bool:
        node = step.node
        if node.same_robot_as is not None:
            pair = run.steps[node.same_robot_as]
            if pair.robot is not None and pair.robot != robot.id and node.action != "put":
                return False
        if node.action == "put" or node.item is not None:
            return robot.inventory == node.item
        if node.action == "pickup":
            thing = self._things.get(node.object)
            return not robot.full_handed and (thing is None or robot.ability.lifts(thing.type))
        if node.action == "slice":
            held = self._things.get(robot.inventory)
            return held is not None and held.type in BLADES
        if node.action == "clean":
            return not robot.full_handed
        return True

    def _way(self, step: Step, robot: Robot) -> float:
        """Metres to walk, with the turn of the body and the tilt of the camera counted in."""
        place = self.place(step)
        if place is None:
            return 0.0
        walk_m = self.distances.walk_m(robot.xy, (place[0], place[1]))
        if walk_m == inf:
            return FORBIDDEN
        if robot.flies:
            return walk_m + (0.0 if robot.airborne else _TAKE_OFF_M)
        turn = abs(wrap_rad(atan2(place[1] - robot.xy[1], place[0] - robot.xy[0]) - robot.yaw_rad)) / pi
        tilt = abs(atan2(_MAST_M - place[2], 1.0) - _HORIZON_RAD)
        return walk_m + _TURN_M_PER_RAD * turn * pi + _TILT_M_PER_RAD * tilt

    def short_of_power(self, step: Step, robot: Robot) -> str:
        """Why the battery of what flies does not do for the way there and back; empty where it does or is not told.

        Back is where it last stood. What is down to its reserve is sent nowhere, whatever the way.
        """
        if not robot.flies or robot.battery is None or step.node.action in _COMING_DOWN:
            return ""
        place = self.place(step)
        there = (place[0], place[1]) if place is not None else robot.xy
        way_m = self.distances.walk_m(robot.xy, there) + self.distances.walk_m(there, robot.home_m or robot.xy)
        if way_m == inf:
            return ""
        seconds = way_m / min(robot.speed_mps or _USUAL_MPS, _USUAL_MPS) + _AT_WORK_S
        needed = _RESERVE + seconds / (robot.endurance_s or _ENDURANCE_S)
        if robot.battery >= needed:
            return ""
        return f"the battery of {robot.id} is at {robot.battery:.0%}; {needed:.0%} is needed for the way there and back"

    def without_power(self, ready: Sequence[Step], robots: Sequence[Robot]) -> str:
        """A sentence, where nothing that is ready can be started for want of power; empty otherwise."""
        said = []
        for step in ready:
            able = [r for r in robots if {step.node.action, *step.node.req_skills} <= set(r.skills)]
            short = [(r.id, why) for r in able if (why := self.short_of_power(step, r))]
            if not short or len(short) < len(able):
                return ""
            said += [f"{id} could not {step.deed}: {why}" for id, why in short]
        return said[0] if said else ""

    def place(self, step: Step) -> Vec3 | None:
        """Where a node takes place."""
        node = step.node
        thing = self._things.get(node.object)
        if thing is not None:
            return (thing.x, thing.y, thing.z)
        point: Vec2 | None = node.point_m
        if point is None and node.room is not None:
            point = mean_m(self._floor.polygons[node.room])
        return (point[0], point[1], 0.0) if point is not None else None
