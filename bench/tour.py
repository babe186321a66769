"""A planner's process for measurements: every robot goes from room to room, which needs no eyes.

`python -m bench.tour --site FILE --id ID`
"""

from collections.abc import Sequence

from planners.core import PlannerCore
from wire.messages.plan import Plan, PlanNode, PlanReply, PlanRequest
from wire.process import main
from wire.site import Site

LAPS = 2


class Tour:
    """See planners.planner.Planner. Whatever is asked, the plan is the same."""

    def __init__(self, rooms: Sequence[str]) -> None:
        self._rooms = rooms

    def make_plan(self, request: PlanRequest) -> PlanReply:
        nodes = [node for start, robot in enumerate(request.world.robots) for node in self._nodes(robot.id, start)]
        plan = Plan(id=f"tour-{request.task}"[:32], task=request.task, planner="tour", goals=(), nodes=tuple(nodes))
        return PlanReply(task=request.task, epoch=request.epoch, plan=plan)

    def _nodes(self, robot: str, start: int) -> list[PlanNode]:
        """One robot's way, a node after the other."""
        count = LAPS * len(self._rooms)
        ids = [f"{robot}-{number}" for number in range(count)]
        rooms = [self._rooms[(start + number) % len(self._rooms)] for number in range(count)]
        return [
            PlanNode(
                id=id,
                action="goto",
                room=room,
                preferred_robot=robot,
                same_robot_as=ids[number - 1] if number else None,
                after=(ids[number - 1],) if number else (),
            )
            for number, (id, room) in enumerate(zip(ids, rooms, strict=True))
        ]


def build(site: Site, process_id: str) -> PlannerCore:
    return PlannerCore(Tour([room.id for room in site.room]))


if __name__ == "__main__":
    main(build)
