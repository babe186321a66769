"""Jobs to the nodes of a plan: who does what in which order, and the edges that keep it."""

from collections.abc import Sequence

from planners.tasks.belief import Belief
from planners.tasks.schedule import Problem, Shift, Wait, schedule
from planners.tasks.search_order import Hunt, search_order
from planners.tasks.travel import area_m2
from planners.tasks.work import STEP_S, Impossible, Job, Step
from wire.messages.plan import PlanNode
from wire.messages.world import RobotState
from wire.model import Vec2
from wire.site import Site

LOOK_S_PER_M2 = 1.0


class Emitter:
    """Assigns jobs to robots and writes the nodes."""

    def __init__(self, site: Site, belief: Belief) -> None:
        self._belief = belief
        self._areas_m2 = {room.id: area_m2(room) for room in site.room}

    def nodes(self, jobs: Sequence[Job]) -> tuple[PlanNode, ...]:
        """The graph: steps of a job in a chain, jobs of a robot one after another, waits between jobs.

        The robot of a node is a preference, so that the hub may still give it to whoever is free; the order within a
        robot's list is an edge.
        """
        robots = self._belief.robots
        if not robots:
            raise Impossible("no robot is there")
        acts = [i for i, job in enumerate(jobs) if not _is_search(job)]
        hunts = [i for i, job in enumerate(jobs) if _is_search(job)]
        lists, free_s, free_m = self._assign_acts(jobs, acts, robots)
        for robot, rooms in enumerate(self._assign_searches(jobs, hunts, robots, free_s, free_m)):
            lists[robot].extend(rooms)
        return self._write(jobs, lists, robots)

    def _able(self, job: Job, robots: Sequence[RobotState]) -> tuple[int, ...]:
        """Robots with the skills, preferably one that has not failed at it."""
        needed = {step.action for step in job.steps}
        able = [i for i, r in enumerate(robots) if needed <= set(r.skills) and job.robot in (None, r.id)]
        if not able:
            raise Impossible(f"no robot can {' and '.join(sorted(a.replace('_', ' ') for a in needed))}")
        failed = {who for s in job.steps for who in self._belief.failures.robots(s.action, s.object or s.room or "")}
        fresh = [i for i in able if robots[i].id not in failed]
        return tuple(fresh or able)

    def _seconds(self, step: Step) -> float:
        extra = LOOK_S_PER_M2 * self._areas_m2.get(step.room or "", 0.0) if step.action == "explore" else 0.0
        return STEP_S[step.action] + extra

    def _duration_s(self, job: Job, upto: int | None = None) -> float:
        """From the entry to the end of a job, or to the beginning of one of its steps."""
        steps = job.steps if upto is None else job.steps[:upto]
        way = zip(job.steps, job.steps[1 : len(job.steps) if upto is None else upto + 1], strict=False)
        return sum(map(self._seconds, steps)) + sum(self._belief.travel.seconds(a.point_m, b.point_m) for a, b in way)

    def _assign_acts(
        self, jobs: Sequence[Job], acts: Sequence[int], robots: Sequence[RobotState]
    ) -> tuple[list[list[int]], list[float], list[Vec2]]:
        """Lists of jobs for each robot; when and where each will be free."""
        place = {job: k for k, job in enumerate(acts)}
        starts = [_floor(robot) for robot in robots]
        if not acts:
            return [[] for _ in robots], [0.0] * len(robots), starts
        shifts = tuple(
            Shift(
                self._duration_s(jobs[i]),
                self._able(jobs[i], robots),
                tuple(Wait(place[w], self._duration_s(jobs[i], step)) for step, w in jobs[i].waits if w in place),
            )
            for i in acts
        )
        seconds = self._belief.travel.seconds
        problem = Problem(
            shifts,
            tuple(tuple(seconds(start, jobs[i].entry_m) for i in acts) for start in starts),
            tuple(tuple(seconds(jobs[i].exit_m, jobs[j].entry_m) for j in acts) for i in acts),
        )
        sequences, timing = schedule(problem)
        lists = [[acts[k] for k in sequence] for sequence in sequences]
        ends = [jobs[own[-1]].exit_m if own else start for own, start in zip(lists, starts, strict=True)]
        return lists, list(timing.robot_end_s), ends

    def _assign_searches(
        self,
        jobs: Sequence[Job],
        hunts: Sequence[int],
        robots: Sequence[RobotState],
        free_s: Sequence[float],
        free_m: Sequence[Vec2],
    ) -> list[list[int]]:
        if not hunts:
            return [[] for _ in robots]
        able = sorted({r for i in hunts for r in self._able(jobs[i], robots)})
        seconds = self._belief.travel.seconds
        total = sum(jobs[i].weight for i in hunts) or 1.0
        hunt = Hunt(
            tuple(jobs[i].weight / total for i in hunts),
            tuple(self._duration_s(jobs[i]) for i in hunts),
            tuple(free_s[r] for r in able),
            tuple(tuple(seconds(free_m[r], jobs[i].entry_m) for i in hunts) for r in able),
            tuple(tuple(seconds(jobs[i].exit_m, jobs[j].entry_m) for j in hunts) for i in hunts),
        )
        lists: list[list[int]] = [[] for _ in robots]
        for robot, order in zip(able, search_order(hunt), strict=True):
            lists[robot] = [hunts[k] for k in order]
        return lists

    def _write(self, jobs: Sequence[Job], lists: list[list[int]], robots: Sequence[RobotState]) -> tuple[PlanNode, ...]:
        names: dict[tuple[int, int], str] = {}
        order = [(r, i) for r, own in enumerate(lists) for i in own]
        for _, i in order:
            for step in range(len(jobs[i].steps)):
                names[i, step] = f"n{len(names) + 1}"
        nodes = []
        for robot, i in order:
            before = lists[robot][: lists[robot].index(i)]
            for number in range(len(jobs[i].steps)):
                after = [names[i, number - 1]] if number else _last(jobs, names, before)
                after += [names[w, len(jobs[w].steps) - 1] for at, w in jobs[i].waits if at == number]
                nodes.append(self._node(jobs[i], number, names, i, after, robots[robot].id))
        return tuple(nodes)

    def _node(
        self, job: Job, number: int, names: dict[tuple[int, int], str], i: int, after: list[str], robot: str
    ) -> PlanNode:
        step = job.steps[number]
        carries = number > 0 and step.item is not None
        first = next((k for k in range(number) if job.steps[k].action == "pickup"), None)
        return PlanNode(
            id=names[i, number],
            action=step.action,
            object=step.object,
            item=step.item,
            room=step.room,
            looking_for=step.looking_for,
            req_skills=(step.action,),
            preferred_robot=robot,
            same_robot_as=names[i, first] if carries and first is not None else None,
            after=tuple(dict.fromkeys(after)),
            goal=job.goal,
        )


def _last(jobs: Sequence[Job], names: dict[tuple[int, int], str], before: list[int]) -> list[str]:
    return [names[before[-1], len(jobs[before[-1]].steps) - 1]] if before else []


def _is_search(job: Job) -> bool:
    """A job that nothing waits for and that waits for nothing: looking for something unknown."""
    return job.weight > 0.0


def _floor(robot: RobotState) -> Vec2:
    return (robot.position_enu_m[0], robot.position_enu_m[1])
