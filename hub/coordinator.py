"""The hub's process without its shell: events to the parts, deltas, orders and states out, services answered."""

from collections.abc import Sequence
from math import inf
from pathlib import Path

from hub.conductor import Conductor
from hub.desk import Desk
from hub.directions import Directions
from hub.dispatch import Dispatch
from hub.hands import Hands
from hub.journal import Journal
from hub.ledger import Ledger
from hub.memory import read_world, write_world
from hub.recovery import Recovery
from hub.voice import Voice
from hub.world import World
from wire.bus import Event, Node, Presence, Received, Reply, Request
from wire.messages.command import Command, DeviceCard, GoalsReply, Result, RobotReport
from wire.messages.driver import DeviceReport
from wire.messages.observation import ObservationBatch
from wire.messages.plan import PlanReply
from wire.site import Site, state_dir

_TRAFFIC_S = 0.2
_SNAPSHOT_S = 5.0
_STATE_S = 1.0
_CARD_S = 3.0
_EARLY_S = 1e-6


class Coordinator:
    """See wire.bus.Core. Algorithm 1 of the first paper lives in `hub.conductor`."""

    def __init__(self, site: Site, process_id: str, journal: Journal) -> None:
        self._site, self._id, self._journal = site, process_id, journal
        self.world = World(site, seed=0)
        self._dispatch = Dispatch(self.world.floor, self.world.things)
        self._directions = Directions(site, self.world.floor, self.world.things)
        self._asked_card_s: dict[str, float] = {}
        self._devices = {p.id for p in site.process if p.role in ("robot", "cctv")}
        self._others = {p.id for p in site.process} - self._devices
        self._planners = {p.id for p in site.process if p.role == "planner"}
        self._due = {"traffic": 0.0, "snapshot": 0.0, "state": 0.0}
        self._now_s = 0.0
        self._restored = False

    def start(self, node: Node) -> None:
        self._node = node
        epoch = self._journal.next_epoch()
        planners = frozenset(self._planners)
        self._voice = voice = Voice(node, epoch, planners, self._site.planner.longest_s)
        self.world.things.reseed(epoch)
        ledger = Ledger(self.world, self._journal, voice)
        self._conductor = conductor = Conductor(
            self.world, self._dispatch, ledger, voice, epoch, self._site.hub.max_fails
        )
        self._hands = Hands(self.world, self._dispatch, conductor, self._journal, voice, epoch)
        self._recovery = Recovery(self.world, conductor)
        self._desk = Desk(self.world, conductor, self._journal, voice)
        voice.on_plan = self._planned
        voice.on_refused = self._refused
        voice.on_goals = self._goals
        voice.on_card = self._card
        for topic in ("observation", "device_report", "robot_report", "result"):
            node.subscribe(topic)
        for service in ("snapshot", "task", "task_query", "calls", "control", "why"):
            node.serve(service)
        node.watch_presence()

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        if not self._restored:
            self._restored = True
            self._restore(now_s)
        self._now_s = now_s
        for event in events:
            self._hear(event, now_s)
        for robot in self.world.fleet.check(now_s):
            self._conductor.lost(robot, now_s)
        for robot in self._recovery.due(now_s):
            self._voice.ask_goals(robot)
        self._tell_changes(now_s)
        self._desk.step(now_s)
        self._hands.settle(now_s)
        self._conductor.advance(now_s)
        if self._is_due("traffic", _TRAFFIC_S, now_s):
            self._direct_traffic(now_s)
        task = self._conductor.task
        if task is not None and not task.ended:
            if self._is_due("snapshot", _SNAPSHOT_S, now_s):
                self._journal.keep({"world": write_world(self.world)})
            if self._is_due("state", _STATE_S, now_s):
                self._conductor.look_for_help(now_s)
                task.measure(self.world)
                task.judge(self.world.snapshot(now_s))
                self._voice.show(task)
        self._voice.publish(now_s)
        self.world.upkeep(now_s)

    def rests_until_s(self) -> float:
        """While nobody moves and no task is open, all that comes can wait."""
        task = self._conductor.task
        open_task = task is not None and not task.ended
        return 0.0 if open_task or self.world.fleet.at_work() else inf

    def stop(self) -> None:
        self._journal.close()

    def _restore(self, now_s: float) -> None:
        """Go on from the journal: the tasks, and with an unfinished one the world as it was believed."""
        remembered = self._journal.read("world")
        if self._desk.restore(now_s) and remembered is not None:
            read_world(self.world, remembered)

    def _is_due(self, what: str, period_s: float, now_s: float) -> bool:
        if now_s < self._due[what] - _EARLY_S:
            return False
        self._due[what] = now_s + period_s
        return True

    def _hear(self, event: Event, now_s: float) -> None:
        if isinstance(event, Received):
            self._receive(event, now_s)
        elif isinstance(event, Reply):
            self._voice.answered(event, now_s)
        elif isinstance(event, Request):
            self._desk.answer(event, now_s)
        elif isinstance(event, Presence):
            self._meet(event, now_s)

    def _receive(self, event: Received, now_s: float) -> None:
        message = event.message
        if isinstance(message, ObservationBatch):
            self.world.observe(message)
        elif isinstance(message, RobotReport):
            robot = self.world.report_robot(message)
            if robot.card is None and now_s - self._asked_card_s.get(robot.id, -1e9) > _CARD_S:
                self._asked_card_s[robot.id] = now_s
                self._voice.ask_card(robot.id)
        elif isinstance(message, DeviceReport):
            self.world.report_device(message)
        elif isinstance(message, Result):
            self._conductor.result(message, now_s)

    def _meet(self, event: Presence, now_s: float) -> None:
        if event.process in self._planners:
            self._voice.planner_presence(event.process, event.alive)
        elif not event.alive:
            self.world.fleet.gone(event.process)
            self._conductor.lost(event.process, now_s)
        elif event.process in self._devices or (event.process not in self._others and event.process != self._id):
            self._asked_card_s[event.process] = now_s
            self._voice.ask_card(event.process)

    def _planned(self, reply: PlanReply | None, error: str) -> None:
        self._conductor.planned(reply, self._now_s, error)

    def _refused(self, command: Command, reason: str) -> None:
        result = Result(
            goal_id=command.goal_id,
            robot=command.robot,
            stamp_s=self._now_s,
            status="failed",
            code="refused",
            reason=reason,
        )
        self._conductor.result(result, self._now_s)

    def _goals(self, reply: GoalsReply) -> None:
        self._recovery.take(reply, self._now_s)

    def _card(self, card: DeviceCard) -> None:
        if card.skills:
            self.world.fleet.take_card(card)

    def _tell_changes(self, now_s: float) -> None:
        delta = self.world.delta(now_s)
        if delta is None:
            return
        self._node.publish("world_delta", delta)
        changed = [o.id for o in delta.objects] + list(delta.removed)
        if changed:
            self._conductor.changed(changed, now_s)

    def _direct_traffic(self, now_s: float) -> None:
        for order in self._directions.orders(self.world.fleet.here(), now_s):
            self._node.publish("traffic", order, order.robot)


def build(site: Site, process_id: str, journal: Path | None = None) -> Coordinator:
    """The hub of a site, with its journal in the site's state folder if not told otherwise."""
    return Coordinator(site, process_id, Journal(journal or state_dir(site) / f"{process_id}.sqlite"))
