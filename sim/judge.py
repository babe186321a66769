"""The evaluator's memory and verdict: which rooms were entered, which things were seen, which goals are true and came
true in order."""

from collections.abc import Mapping, Sequence
from math import hypot

from sim.boxes import body_box
from sim.cameras import MAST_FOCAL_PX, MAST_HEIGHT_PX, MAST_WIDTH_PX
from sim.carrier import Arm
from sim.chronicle import Chronicle
from sim.deeds import breach
from sim.overhead import Overhead
from sim.physics import Physics
from sim.rover import Rover
from sim.scene import Scene
from sim.sight import is_visible, obstacles_around
from sim.truth import NOTHING_ABOVE, Above, Truth, room_of
from wire.frames import project
from wire.goals import holds
from wire.messages.goal import Goal
from wire.messages.operator import GoalState
from wire.messages.truth import JudgeReply, JudgeRequest, TruthTask
from wire.messages.world import WorldState

SEEN_WITHIN_M = 3.0


class Judge:
    def __init__(self, scene: Scene, physics: Physics, arms: Mapping[str, Arm], task: TruthTask) -> None:
        self._scene = scene
        self._physics = physics
        self._arms = arms
        self._task = task
        self._truth = Truth(scene)
        self._visited: set[str] = set()
        self._verified: set[int] = set()
        self._seq = 0
        self._chronicle = Chronicle()
        self._overhead = Overhead(scene)

    def watch(self, now_s: float) -> WorldState:
        """Note where the robots are, what their mast cameras see from near, what their hands have handled and what has
        come true; the world as it is."""
        self._verified |= {deed.target for arm in self._arms.values() for deed in arm.deeds}
        for id, rover in self._physics.robots.items():
            room = room_of(self._scene, rover.motion().position_m)
            if room is not None:
                self._visited.add(room)
            self._verified |= self._seen_from(id, rover)
        self._overhead.watch(self._physics.drones, now_s)
        world = self._world(now_s)
        self._chronicle.note(world)
        return world

    def _seen_from(self, id: str, rover: Rover) -> set[int]:
        eye_m, yaw_rad = rover.eye_m(), rover.motion().yaw_rad
        near = [
            key
            for key, body in self._scene.bodies.items()
            if key not in self._verified
            and hypot(body.position_m[0] - eye_m[0], body.position_m[1] - eye_m[1]) <= SEEN_WITHIN_M
            and not body.gone
            and _in_picture(body_box(body).centre_m, eye_m, yaw_rad, rover.tilt_down_rad)
        ]
        if not near:
            return set()
        others = [other.box() for name, other in self._physics.robots.items() if name != id]
        around = obstacles_around(self._scene, self._physics.structure, others, eye_m, SEEN_WITHIN_M)
        return {key for key in near if is_visible(self._scene, around, eye_m, key)}

    def _world(self, now_s: float) -> WorldState:
        self._seq += 1
        robots = {id: rover.motion() for id, rover in self._physics.robots.items()}
        drones = {id: drone.true_pose() for id, drone in self._physics.drones.items()}
        over = self._overhead
        above = Above(over.rooms, over.surveyed, over.things) if drones else NOTHING_ABOVE
        return self._truth.world(robots, self._visited, self._verified, now_s, self._seq, drones, above)

    def verdict(self, request: JudgeRequest, now_s: float, sim_s: float) -> JudgeReply:
        """Judge the goals asked about, or the scene's own."""
        goals = self._task.goals if request.goals is None else request.goals
        world = self._world(now_s)
        self._chronicle.note(world)
        states = tuple(self._state(goals, index, request.since_s, world) for index in range(len(goals)))
        return JudgeReply(
            stamp_s=now_s,
            task=self._task,
            goals=states,
            success=all(state.holds for state in states),
            collisions=self._physics.collisions,
            sim_s=sim_s,
        )

    def _state(self, goals: Sequence[Goal], index: int, since_s: float, world: WorldState) -> GoalState:
        """A goal that came true before those it should come after is not reached, whatever is true now."""
        goal = goals[index]
        if not goal.forbidden:
            reached = holds(goal, world)
            note = self._chronicle.disorder(goals, index, since_s) if reached else ""
            return GoalState(goal=goal, holds=reached and not note, note=note)
        deeds = [deed for arm in self._arms.values() for deed in arm.deeds]
        note = breach(goal, deeds, self._visited, world)
        return GoalState(goal=goal, holds=not note, note=note)


def _in_picture(
    point_m: tuple[float, float, float], eye_m: tuple[float, float, float], yaw_rad: float, tilt_down_rad: float
) -> bool:
    pixel = project(point_m, eye_m, yaw_rad, tilt_down_rad, MAST_WIDTH_PX, MAST_HEIGHT_PX, MAST_FOCAL_PX)
    return pixel is not None and 0.0 <= pixel[0] < MAST_WIDTH_PX and 0.0 <= pixel[1] < MAST_HEIGHT_PX
