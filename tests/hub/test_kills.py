"""A hub that is killed at any moment around a grasp goes on: no step twice, nothing forgotten that is in a hand."""

from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path

import pytest

from hub.world import World
from tests.hub.home import Flat
from tests.hub.scenes import card, flat, report
from tests.hub.test_episode import fetch
from tests.hub.toys import ToyRobot
from wire.messages.command import Command
from wire.messages.observation import Absence, ObjectObservation
from wire.messages.operator import ControlRequest, TaskQuery, TaskState
from wire.messages.plan import PlanReply, PlanRequest, Refusal

SEEN_UNTIL_S = 3.0
AROUND = 16
"""Ticks before and after the end of a grasp: the whole of its work, its report, the next command."""


def fetch_if_anybody_is_there(request: PlanRequest) -> PlanReply:
    if request.world.robots:
        return fetch(request)
    return PlanReply(task=request.task, epoch=request.epoch, refusal=Refusal(reason="no robot is there"))


class DarkFlat(Flat):
    """Nobody looks at anything after the task was asked for; the camera may say that the apple has gone."""

    def __init__(self, journal: Path | None = None, says_gone: bool = False, fail=lambda c: None) -> None:
        super().__init__(fetch_if_anybody_is_there, journal, fail)
        self.camera.gone = self._gone if says_gone else lambda now_s: ()

    def _look(self, now_s: float) -> Sequence[ObjectObservation]:
        return super()._look(now_s) if now_s < SEEN_UNTIL_S else ()

    def _gone(self, now_s: float) -> Sequence[Absence]:
        if not any(robot.holding for robot in self.robots):
            return ()
        return (Absence(track="apple", type="Apple", position_enu_m=(2.1, 2.2, 0.83), confidence=0.95),)

    def done(self) -> list[str]:
        """Actions that robots have carried out."""
        return [self.actions(r.goal_id).split()[-1] for s in self.robots for r in s.results if r.code == "ok"]

    def begin(self) -> None:
        self.mesh.run(SEEN_UNTIL_S)
        self.ask()


@cache
def ticks_until(action: str) -> int:
    """Ticks from the question to the end of an action when nobody is killed."""
    home = DarkFlat()
    home.begin()
    for tick in range(2400):
        home.mesh.tick()
        if action in home.done():
            return tick
    raise AssertionError(f"no {action} in two minutes")


def killed(journal: Path, after_ticks: int, away_s: float, says_gone: bool) -> tuple[TaskState, list[str]]:
    """How the task ends, and what was done, when the hub is killed so long after the question."""
    home = DarkFlat(journal, says_gone)
    home.begin()
    for _ in range(after_ticks):
        home.mesh.tick()
    home.mesh.remove("hub", stop=False)
    home.mesh.run(away_s)
    home.start_hub()
    state = home.until_end()
    done = home.done()
    home.mesh.close()
    return state, done


@pytest.mark.parametrize("action", ["pickup", "put"])
@pytest.mark.parametrize(("away_s", "says_gone"), [(1.0, False), (25.0, False), (4.0, True)])
def test_killed_at_every_tick_around_a_grasp(action: str, away_s: float, says_gone: bool, tmp_path: Path) -> None:
    for tick in range(ticks_until(action) - AROUND, ticks_until(action) + AROUND // 2):
        state, done = killed(tmp_path / f"{tick}.db", tick, away_s, says_gone)
        assert state.status == "done", (tick, state)
        assert sorted(done) == ["open", "pickup", "put"], (tick, state)
        assert state.fails == 0, (tick, state)


def test_killed_while_it_plans(tmp_path: Path) -> None:
    """It does not plan for an empty house because nobody has announced himself yet."""
    for tick in range(4):
        state, done = killed(tmp_path / f"{tick}.db", tick, 10.0, says_gone=False)
        assert (state.status, state.fails) == ("done", 0), (tick, state)
        assert sorted(done) == ["open", "pickup", "put"], (tick, state)


def test_robots_that_missed_the_hub_are_waited_for() -> None:
    world = World(flat())
    assert not world.fleet.met(1.0)
    world.report_robot(report("dog-1", 1.0, 1.0, 0.0, status="lost"))
    world.fleet.take_card(card("dog-1"))
    assert not world.fleet.met(1.0), "it has not heard of the hub again, and counts for nothing in plans"
    world.report_robot(report("dog-1", 1.0, 1.0, 0.1))
    assert world.fleet.met(1.0)


def _once(action: str) -> Callable[[Command], str | None]:
    """Has an action fail the first time."""
    failing = iter(["blocked"])
    return lambda command: next(failing, None) if command.action == action else None


def test_killed_at_every_tick_around_a_failure(tmp_path: Path) -> None:
    """What was to be planned anew is planned anew at once, and counts once."""
    for tick in range(ticks_until("pickup") - 2, ticks_until("pickup") + 8):
        home = DarkFlat(tmp_path / f"{tick}.db", fail=_once("pickup"))
        home.begin()
        for _ in range(tick):
            home.mesh.tick()
        home.mesh.remove("hub", stop=False)
        home.start_hub()
        state = home.until_end(60.0)
        assert state.status == "done", (tick, state)
        assert (state.fails, sorted(home.done())) == (1, ["open", "pickup", "put"]), (tick, state)
        home.mesh.close()


def test_a_pause_outlives_the_hub(tmp_path: Path) -> None:
    home = DarkFlat(tmp_path / "hub.db")
    home.begin()
    home.mesh.run(2.0)
    home.mesh.call("control", ControlRequest(verb="pause"))
    home.mesh.remove("hub", stop=False)
    home.start_hub()
    home.mesh.run(10.0)
    assert home.mesh.call("task_query", TaskQuery()).status == "paused"


def test_a_restored_world_keeps_its_ids(tmp_path: Path) -> None:
    home = DarkFlat(tmp_path / "hub.db")
    home.begin()
    home.mesh.run(1.0)
    before = {o.id: o.type for o in home.hub.world.snapshot(4.0).objects}
    home.mesh.remove("hub", stop=False)
    home.mesh.run(60.0)
    home.start_hub()
    home.mesh.run(2.0)
    assert {o.id: o.type for o in home.hub.world.snapshot(66.0).objects} == before
    drawn = [home.hub.world.things.new("Mug", (1.0, 1.0, 1.0), 66.0).id for _ in range(20)]
    assert not {World(home.site).things.new("Mug", (1.0, 1.0, 1.0), 0.0).id} & set(drawn), "ids of the first run"


def _holding(home: Flat, type: str | None) -> ToyRobot:
    """dog-1 stands at the table with something in its hand, of which no hub was ever told."""
    robot = home.robots[0]
    robot.xy, robot.holding, robot.holding_type = (2.0, 1.2), True, type
    return robot


def test_what_is_in_a_hand_is_recognised_by_its_type() -> None:
    home = DarkFlat()
    home.mesh.run(SEEN_UNTIL_S)
    _holding(home, "Apple")
    home.mesh.run(3.0)
    home.ask()
    state = home.until_end()
    assert (state.status, state.fails) == ("done", 0), state
    assert "pickup" not in home.done(), "it had the apple already"
    (apple,) = [o for o in home.hub.world.snapshot(99.0).objects if o.type == "Apple"]
    assert apple.receptacle == next(o.id for o in home.hub.world.snapshot(99.0).objects if o.type == "Fridge")


def test_what_nobody_can_name_is_put_down() -> None:
    home = DarkFlat()
    home.mesh.run(SEEN_UNTIL_S)
    full, other = _holding(home, None), home.robots[1]
    home.ask()
    state = home.until_end()
    assert (state.status, state.fails) == ("done", 0), state
    home.mesh.run(20.0)
    assert [r.goal_id for r in full.results if r.goal_id.startswith("hands-")] == ["hands-e0-1"]
    assert not full.holding
    assert "pickup" in {home.actions(r.goal_id).split()[-1] for r in other.results}, "whose hand was free"


def test_nothing_moves_without_a_task() -> None:
    home = DarkFlat()
    home.mesh.run(SEEN_UNTIL_S)
    robot = _holding(home, None)
    home.mesh.run(20.0)
    assert robot.walked == 0.0
    assert robot.holding


def test_who_has_said_what_he_can_and_not_yet_where_he_is_is_waited_for() -> None:
    world = World(flat())
    world.report_robot(report("dog-1", 1.0, 1.0, 0.0))
    world.fleet.take_card(card("dog-1"))
    world.fleet.take_card(card("drone-1"))
    assert not world.fleet.met(1.0)
    assert world.fleet.met(5.0), "not for ever"
    world.report_robot(report("drone-1", 2.0, 1.0, 0.1))
    assert world.fleet.met(1.0)
    assert "drone-1" in world.fleet.able().values()
    for status in ("lost", "fault"):
        world.report_robot(report("drone-1", 2.0, 1.0, 0.2, status=status))
        assert "drone-1" not in world.fleet.able().values()
    world.fleet.gone("drone-1")
    assert world.fleet.met(1.0), "nor for who went away"
