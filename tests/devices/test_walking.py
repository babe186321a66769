"""A robot that walks: through doors, around what it meets, and not when it must not."""

from math import hypot

import pytest

from devices.goals_journal import open_journal
from devices.quadruped.core import QuadrupedCore
from tests.devices.driver import Driver, Hub, away_m, box, command, two_rooms
from wire.loopback import LoopbackMesh
from wire.messages.command import CancelRequest, CardRequest, DeviceCard
from wire.site import Site


class Yard:
    """A driver, a robot and a hub on one mesh."""

    def __init__(self, site: Site | None = None, driver: Driver | None = None) -> None:
        site = site or two_rooms()
        self.driver, self.hub, self.mesh = driver or Driver(site), Hub(), LoopbackMesh()
        self.journal = open_journal()
        self.mesh.add(self.driver, "sim", "sim", owner=True)
        self.mesh.add(self.hub, "hub", "hub")
        self.mesh.add(QuadrupedCore(site, "dog-1", self.journal), "dog-1", "robot")

    def until_result(self, limit_s: float) -> None:
        count = len(self.hub.results)
        for _ in range(round(limit_s / 0.05)):
            self.mesh.tick()
            if len(self.hub.results) > count:
                return
        raise AssertionError(f"no result in {limit_s} s: {self.hub.acks} {self.hub.reports[-1]}")


@pytest.fixture
def yard() -> Yard:
    return Yard()


def test_walks_through_a_door(yard: Yard) -> None:
    yard.hub.send(command("g-1", point_m=(7.0, 3.0)))
    yard.until_result(25.0)
    result = yard.hub.results[0]
    assert (result.status, result.code) == ("done", "ok")
    assert away_m(yard.driver, (7.0, 3.0)) < 0.25
    assert yard.driver.contacts == 0
    assert 6.1 < result.travelled_m < 8.0
    assert 2 <= result.action_steps <= 10
    assert yard.hub.acks[0].status == "running"


@pytest.mark.parametrize("start_m", [(1.0, 3.3), (3.2, 0.8), (3.4, 3.4)])
def test_doorway_keeps_clear_of_the_jambs(start_m: tuple[float, float]) -> None:
    site = two_rooms()
    yard = Yard(site, Driver(site, start_m, noise_m=0.01))
    yard.hub.send(command("g-1", room="east"))
    yard.until_result(25.0)
    assert yard.hub.results[0].status == "done"
    assert yard.driver.x > 4.6
    assert yard.driver.nearest_m > 0.36
    assert yard.driver.contacts == 0


def test_goes_around_furniture_it_sees(yard: Yard) -> None:
    yard.driver.boxes += box(2.5, 1.4, 0.8, 1.0)
    yard.hub.send(command("g-1", point_m=(3.4, 1.0)))
    yard.until_result(30.0)
    assert yard.hub.results[0].status == "done"
    assert yard.driver.contacts == 0


def test_replans_when_the_way_becomes_blocked(yard: Yard) -> None:
    yard.hub.send(command("g-1", point_m=(1.0, 3.4)))
    yard.mesh.run(0.5)
    yard.driver.boxes += box(1.0, 2.4, 1.0, 0.3)
    yard.until_result(30.0)
    assert yard.hub.results[0].status == "done"
    assert yard.driver.contacts == 0


def test_says_that_there_is_no_way(yard: Yard) -> None:
    yard.driver.boxes += box(4.0, 2.0, 0.3, 1.2)
    yard.hub.send(command("g-1", room="east"))
    yard.until_result(60.0)
    assert (yard.hub.results[0].status, yard.hub.results[0].code) == ("failed", "unreachable")


def test_cancel_stops_within_two_ticks(yard: Yard) -> None:
    yard.hub.send(command("g-1", point_m=(3.0, 1.0)))
    yard.mesh.run(2.0)
    assert yard.driver.velocity.forward_mps > 0.3
    yard.hub.to_ask.append(("cancel", CancelRequest(robot="dog-1", epoch=1)))
    yard.mesh.run(0.15)
    assert yard.driver.velocity.forward_mps == 0.0
    yard.mesh.run(0.1)
    assert [r.status for r in yard.hub.results] == ["cancelled"]


def test_rests_while_it_stands_and_takes_every_step_while_it_has_a_goal(yard: Yard) -> None:
    def commands_in(seconds: float) -> int:
        before = yard.driver.velocity.seq
        yard.mesh.run(seconds)
        return yard.driver.velocity.seq - before

    yard.mesh.run(1.0)
    reported = len(yard.hub.reports)
    assert commands_in(3.0) <= 3
    assert len(yard.hub.reports) - reported <= 6
    yard.hub.send(command("g-1", point_m=(3.0, 1.0)))
    yard.mesh.run(0.3)
    assert commands_in(2.0) == 40
    yard.until_result(10.0)
    yard.mesh.run(0.5)
    assert yard.driver.velocity.forward_mps == 0.0
    assert commands_in(3.0) <= 3


def test_stands_still_without_the_hub_and_goes_on_with_it(yard: Yard) -> None:
    yard.hub.send(command("g-1", point_m=(7.0, 3.0)))
    yard.mesh.run(2.0)
    yard.mesh.remove("hub", stop=False)
    yard.mesh.run(2.3)
    place = (yard.driver.x, yard.driver.y)
    yard.mesh.run(5.0)
    assert away_m(yard.driver, place) < 0.01
    yard.mesh.add(yard.hub, "hub", "hub")
    yard.until_result(25.0)
    assert yard.hub.results[0].status == "done"


def test_gives_the_goal_up_when_the_hub_stays_away(yard: Yard) -> None:
    yard.hub.send(command("g-1", point_m=(7.0, 3.0)))
    yard.mesh.run(2.0)
    yard.mesh.remove("hub", stop=False)
    yard.mesh.run(33.0)
    record = yard.journal.record("g-1")
    assert record is not None
    assert (record.status, record.code) == ("failed", "lost_hub")


def test_obeys_the_traffic_order(yard: Yard) -> None:
    yard.hub.send(command("g-1", point_m=(3.4, 1.0)))
    yard.mesh.run(1.0)
    yard.hub.go = False
    yard.mesh.run(0.2)
    place = (yard.driver.x, yard.driver.y)
    yard.mesh.run(6.0)
    assert away_m(yard.driver, place) < 0.01
    assert yard.hub.reports[-1].status == "holding"
    yard.hub.step_aside_m = (1.0, 3.0)
    yard.mesh.run(8.0)
    assert away_m(yard.driver, (1.0, 3.0)) < 0.3
    yard.hub.go, yard.hub.step_aside_m = True, None
    yard.until_result(20.0)
    assert yard.hub.results[0].status == "done"


def test_steps_aside_while_idle(yard: Yard) -> None:
    yard.hub.step_aside_m = (2.5, 2.5)
    yard.mesh.run(8.0)
    assert away_m(yard.driver, (2.5, 2.5)) < 0.3


def test_has_no_way_left_when_it_need_not_step_aside_any_more(yard: Yard) -> None:
    yard.hub.step_aside_m = (2.5, 2.5)
    yard.mesh.run(1.5)
    assert yard.hub.reports[-1].path_m
    yard.hub.step_aside_m = None
    yard.mesh.run(0.5)
    assert yard.hub.reports[-1].path_m == ()


def test_keeps_clear_of_other_robots(yard: Yard) -> None:
    yard.hub.others_m = ((2.2, 1.0),)
    yard.hub.send(command("g-1", point_m=(3.4, 1.0)))
    nearest = 9.0
    for _ in range(500):
        yard.mesh.tick()
        nearest = min(nearest, hypot(yard.driver.x - 2.2, yard.driver.y - 1.0))
    assert [r.status for r in yard.hub.results] == ["done"]
    assert nearest > 0.75


def test_another_robot_beyond_the_end_of_the_way_is_not_in_it(yard: Yard) -> None:
    yard.hub.others_m = ((2.98, 1.0),)
    yard.hub.send(command("g-1", point_m=(2.05, 1.05)))
    yard.until_result(15.0)
    assert yard.hub.results[0].status == "done"
    assert away_m(yard.driver, (2.05, 1.05)) < 0.15


def test_a_goal_that_takes_too_long_fails(yard: Yard) -> None:
    yard.hub.send(command("g-1", point_m=(7.0, 3.0), timeout_s=3.0))
    yard.until_result(5.0)
    assert (yard.hub.results[0].status, yard.hub.results[0].code) == ("failed", "timeout")
    yard.mesh.run(0.2)
    assert yard.driver.velocity.forward_mps == 0.0


def test_waiting_for_others_is_not_the_goals_time(yard: Yard) -> None:
    yard.hub.send(command("g-1", point_m=(3.4, 1.0), timeout_s=7.0))
    yard.mesh.run(0.5)
    yard.hub.go = False
    yard.mesh.run(6.0)
    yard.hub.go = True
    yard.until_result(6.0)
    assert yard.hub.results[0].status == "done"


def test_nobody_waits_for_others_for_ever(yard: Yard) -> None:
    yard.hub.go = False
    yard.hub.send(command("g-1", point_m=(3.4, 1.0), timeout_s=5.0))
    yard.until_result(11.0)
    assert (yard.hub.results[0].status, yard.hub.results[0].code) == ("failed", "timeout")


def test_card_tells_planners_what_it_can_do(yard: Yard) -> None:
    card = yard.mesh.call("card", CardRequest(), "dog-1", role="hub")
    assert isinstance(card, DeviceCard)
    assert "goto" in {skill.name for skill in card.skills}
    assert all(len(skill.doc) > 30 and "properties" in skill.parameters for skill in card.skills)
