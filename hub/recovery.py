"""After a restart, or when a result seems lost: ask the robot what became of its goals. Unknown is not 'not done'."""

from hub.conductor import Conductor
from hub.plan import Step
from hub.world import World
from wire.messages.command import GoalRecord, GoalsReply, Result

_QUIET_S = 2.0
_ASK_AGAIN_S = 2.0
_GIVE_UP_S = 12.0


class Recovery:
    """Finds running steps whose robot is not at them."""

    def __init__(self, world: World, conductor: Conductor) -> None:
        self._world, self._conductor = world, conductor
        self._since: dict[str, float] = {}
        self._asked: dict[str, float] = {}

    def due(self, now_s: float) -> list[str]:
        """Robots to be asked for their goals now."""
        steps = self._running()
        self._since = {goal: s for goal, s in self._since.items() if goal in steps}
        robots = []
        for goal_id, step in steps.items():
            robot = self._world.fleet.robots.get(step.robot or "")
            if robot is not None and robot.present and robot.goal_id == goal_id:
                self._since.pop(goal_id, None)
                continue
            since = self._since.setdefault(goal_id, now_s)
            if now_s - since >= _GIVE_UP_S and step.robot is not None and (robot is None or not robot.present):
                self._conductor.lost(step.robot, now_s)
            elif now_s - since >= _QUIET_S and step.robot is not None and self._may_ask(step.robot, now_s):
                robots.append(step.robot)
                self._asked[step.robot] = now_s
        return robots

    def _may_ask(self, robot: str, now_s: float) -> bool:
        return now_s - self._asked.get(robot, -1e9) >= _ASK_AGAIN_S

    def take(self, reply: GoalsReply, now_s: float) -> None:
        """What the robot remembers, as the results that were missed."""
        records = {record.goal_id: record for record in reply.goals}
        for goal_id, step in self._running().items():
            if step.robot != reply.robot:
                continue
            holding = self._world.fleet.robot(reply.robot).holding
            result = _result(goal_id, reply.robot, records.get(goal_id), holding, now_s)
            if result is not None:
                self._conductor.result(result, now_s)

    def _running(self) -> dict[str, Step]:
        task = self._conductor.task
        if task is None or task.run is None:
            return {}
        return {step.goal_id: step for step in task.run.running() if step.goal_id is not None}


def _result(goal_id: str, robot: str, record: GoalRecord | None, holding: bool, now_s: float) -> Result | None:
    """`holding`: as the robot reports it now; it has had no other goal since."""
    if record is None:
        return Result(
            goal_id=goal_id, robot=robot, stamp_s=now_s, status="cancelled", code="cancelled", reason="never arrived"
        )
    if record.status == "accepted" or record.status == "running":
        return None
    return Result(
        goal_id=goal_id,
        robot=robot,
        stamp_s=now_s,
        status=record.status,
        code=record.code,
        reason=record.reason,
        point_enu_m=record.point_enu_m,
        holding=holding,
    )
