"""A plan being carried out: the graph of equation 6 with what has become of each node of equation 7."""

from collections.abc import Mapping

from wire.messages.plan import NodeState, NodeStatus, Plan, PlanNode, PlanState


class Step:
    """One node and its fate."""

    __slots__ = ("ended_s", "goal_id", "node", "ready_s", "reason", "robot", "started_s", "status")

    def __init__(self, node: PlanNode) -> None:
        self.node = node
        self.status: NodeStatus = "pending"
        self.robot: str | None = None
        self.goal_id: str | None = None
        self.reason = ""
        self.ready_s: float | None = None
        self.started_s: float | None = None
        self.ended_s: float | None = None

    @property
    def deed(self) -> str:
        """The action and what it is done to or where, as failures are told to planners: `open fridge-1`."""
        return " ".join(filter(None, (self.node.action, self.node.object or self.node.room)))

    def state(self) -> NodeState:
        return NodeState(
            id=self.node.id,
            status=self.status,
            robot=self.robot,
            reason=self.reason,
            started_s=self.started_s,
            ended_s=self.ended_s,
        )


class PlanRun:
    """Which nodes are ready, run, are done."""

    def __init__(self, plan: Plan, types: Mapping[str, str]) -> None:
        """`types`: of the things in the plan, as they were believed when it was made."""
        self.plan = plan
        named = {id for node in plan.nodes for id in (node.object, node.item)}
        self.types = {id: type for id, type in sorted(types.items()) if id in named}
        self.steps = {node.id: Step(node) for node in plan.nodes}

    def ready(self, now_s: float) -> list[Step]:
        """Pending nodes whose predecessors are all done, in the plan's order."""
        found = []
        for step in self.steps.values():
            if step.status == "pending" and all(self.steps[id].status == "done" for id in step.node.after):
                if step.ready_s is None:
                    step.ready_s = now_s
                found.append(step)
        return found

    def running(self) -> list[Step]:
        return [step for step in self.steps.values() if step.status == "running"]

    def finished(self) -> bool:
        return all(step.status == "done" for step in self.steps.values())

    def done_count(self) -> int:
        return sum(step.status == "done" for step in self.steps.values())

    def of_goal(self, goal_id: str) -> Step | None:
        return next((step for step in self.steps.values() if step.goal_id == goal_id), None)

    def start(self, step: Step, robot: str, goal_id: str, now_s: float) -> None:
        step.status, step.robot, step.goal_id, step.started_s, step.reason = "running", robot, goal_id, now_s, ""

    def end(self, step: Step, status: NodeStatus, now_s: float, reason: str = "") -> None:
        step.status, step.ended_s, step.reason = status, now_s, reason

    def put_back(self, step: Step, reason: str) -> None:
        """To be done again, by whomever."""
        step.status, step.robot, step.goal_id, step.started_s, step.reason = "pending", None, None, None, reason

    def state(self, now_s: float, replans: int) -> PlanState:
        return PlanState(
            task=self.plan.task,
            stamp_s=now_s,
            plan=self.plan,
            nodes=tuple(step.state() for step in self.steps.values()),
            replans=replans,
        )
