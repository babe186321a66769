"""A small flat with two toy robots, a camera and a list of plans, around the real hub."""

import random
from collections.abc import Sequence
from pathlib import Path

from hub.coordinator import Coordinator
from hub.journal import Journal
from tests.hub.scenes import flat, seen
from tests.hub.toys import ToyCamera, ToyPlanner, ToyRobot
from wire.loopback import LoopbackMesh
from wire.messages.goal import Goal, Selector
from wire.messages.observation import ObjectObservation
from wire.messages.operator import TaskQuery, TaskRequest, TaskState
from wire.planner_table import PlannerChoice

GOALS = (Goal(predicate="in", subject=Selector(type="Apple"), object=Selector(type="Fridge"), text="apple in fridge"),)

SCRIPTED = PlannerChoice()


class Flat:
    """Mesh, robots, camera; the apple is seen until it has been taken."""

    def __init__(
        self, answer, journal: Path | None = None, fail=lambda c: None, choice: PlannerChoice = SCRIPTED
    ) -> None:
        self.site = flat().model_copy(update={"planner": choice})
        self.journal = journal
        self.mesh = LoopbackMesh()
        self.robots = [ToyRobot(self.site, "dog-1", (1.0, 1.0), fail), ToyRobot(self.site, "dog-2", (6.0, 1.0), fail)]
        self.random = random.Random(3)
        self.planner = ToyPlanner(answer)
        for robot in self.robots:
            self.mesh.add(robot, robot.id, "robot")
        self.camera = ToyCamera("cam-1", self._look)
        self.mesh.add(self.camera, "cctv-1", "cctv")
        self.mesh.add(self.planner, "planner", "planner")
        self.hub = self.start_hub()

    def start_hub(self) -> Coordinator:
        self.hub = Coordinator(self.site, "hub", Journal(self.journal))
        self.mesh.add(self.hub, "hub", "hub")
        return self.hub

    def _look(self, now_s: float) -> Sequence[ObjectObservation]:
        def noisy(type: str, x: float, y: float, z: float, track: str, **props: float) -> ObjectObservation:
            dx, dy = self.random.gauss(0.0, 0.05), self.random.gauss(0.0, 0.05)
            return seen(type, x + dx, y + dy, z, track, **props)

        things = [noisy("DiningTable", 2.0, 2.0, 0.38, "table"), noisy("Fridge", 6.5, 3.4, 0.92, "fridge", isOpen=0.05)]
        if not any(r.code == "ok" and "pickup" in self.actions(r.goal_id) for s in self.robots for r in s.results):
            things.append(noisy("Apple", 2.1, 2.2, 0.83, "apple"))
        return things

    def actions(self, goal_id: str) -> str:
        return next((body for _, kind, body in self.hub._journal.log() if kind == "command" and goal_id in body), "")

    def ask(self, instruction: str = "put the apple in the fridge") -> TaskState:
        state = self.mesh.call("task", TaskRequest(task="t-1", instruction=instruction))
        assert isinstance(state, TaskState)
        return state

    def until_end(self, seconds: float = 120.0) -> TaskState:
        for _ in range(round(seconds)):
            self.mesh.run(1.0)
            state = self.mesh.call("task_query", TaskQuery(task="t-1"))
            assert isinstance(state, TaskState)
            if state.status in ("done", "failed", "refused", "cancelled"):
                return state
        raise AssertionError(state)
