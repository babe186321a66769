"""Hands that hold what W does not know: the thing is recognised by its type, or else put down."""

from math import inf

from hub import effects
from hub.conductor import Conductor
from hub.dispatch import Dispatch
from hub.fleet import Robot
from hub.journal import Journal
from hub.kinds import shapes
from hub.ledger import log
from hub.orders import put_down
from hub.records import Thing
from hub.voice import Voice
from hub.world import World
from wire.frames import distance_m

_QUIET_S = 2.5
"""A result that is still on its way tells more."""
_TAKEN_WITHIN_M = 2.5
"""A thing of the type that was believed this near to the robot is the one that it took."""
_AGAIN_S = 60.0


class Hands:
    """Watches idle robots. One that holds something unknown is full-handed (`hub.dispatch`) until this is settled."""

    def __init__(
        self, world: World, dispatch: Dispatch, conductor: Conductor, journal: Journal, voice: Voice, epoch: int
    ) -> None:
        self._world, self._dispatch, self._conductor = world, dispatch, conductor
        self._journal, self._voice, self._epoch = journal, voice, epoch
        self._since_s: dict[str, float] = {}
        self._ordered_s: dict[str, float] = {}
        self._orders = 0

    def settle(self, now_s: float) -> None:
        """Settle what has been unknown for a while."""
        for robot in self._world.fleet.here():
            if not robot.holding or robot.inventory is not None or robot.status != "idle" or self._at_work(robot):
                self._since_s.pop(robot.id, None)
            elif now_s - self._since_s.setdefault(robot.id, now_s) >= _QUIET_S:
                self._settle(robot, now_s)

    def _at_work(self, robot: Robot) -> bool:
        task = self._conductor.task
        return task is not None and task.run is not None and any(s.robot == robot.id for s in task.run.running())

    def _settle(self, robot: Robot, now_s: float) -> None:
        task = self._conductor.task
        active = task is not None and task.status in ("planning", "running")
        if robot.holding_type in shapes():
            thing = self._recognised(robot, robot.holding_type, now_s)
            effects.take(self._world, thing, robot.id, now_s)
            if active:
                self._conductor.halt("replan", f"{robot.id} turns out to hold the {thing.type} {thing.id}", now_s)
        elif active and "put" in robot.skills and now_s - self._ordered_s.get(robot.id, -1e9) >= _AGAIN_S:
            self._ordered_s[robot.id] = now_s
            self._put_down(robot, now_s)

    def _recognised(self, robot: Robot, type: str, now_s: float) -> Thing:
        """The nearest thing of the type that is in nobody's hand, or a new one."""
        x, y = robot.xy
        near = [
            (away_m, thing.id, thing)
            for thing in self._world.things.near(x, y, _TAKEN_WITHIN_M)
            if thing.type == type and thing.receptacle not in self._world.fleet.robots
            if (away_m := distance_m((thing.x, thing.y), robot.xy)) <= _TAKEN_WITHIN_M
        ]
        thing = min(near)[2] if near else self._world.things.new(type, robot.position_m, now_s)
        effects.touched(thing, robot.id, now_s)
        return thing

    def _put_down(self, robot: Robot, now_s: float) -> None:
        """Have a robot that cannot say what it holds put it onto the nearest surface."""
        surfaces = [t for t in self._world.things if t.shown >= 0 and t.shape.receptacle_mode == "on" and not t.locked]
        ways = [(self._dispatch.distances.walk_m(robot.xy, (t.x, t.y)), t.id, t) for t in surfaces]
        walk_m, _, surface = min(ways, default=(inf, "", None))
        if surface is None or walk_m == inf:
            return
        self._orders += 1
        goal_id = f"hands-e{self._epoch}-{self._orders}"
        line = f"{goal_id} {robot.id} - put"
        self._journal.decide(now_s, "command", line, {})
        log.info("at %.1f s: command: %s: it cannot say what it holds", now_s, line)
        self._voice.command(put_down(robot, surface, walk_m, goal_id, self._epoch, self._world.things, now_s))
