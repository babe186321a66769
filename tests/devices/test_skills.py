"""Skills that look and handle, from the command to the result, with a driver and a feed of sightings made for tests."""

import pytest

from devices.goals_journal import open_journal
from devices.quadruped.core import QuadrupedCore
from devices.quadruped.reasons import code_of
from devices.quadruped.skills import SKILLS
from tests.devices.driver import Hub, box, command, two_rooms
from tests.devices.workshop import Item, ToldEyes, Workshop
from wire.loopback import LoopbackMesh
from wire.messages.command import CancelRequest, Command, Result, Target


class Room:
    """A workshop, a robot with eyes, and a hub."""

    def __init__(self, *items: Item) -> None:
        site = two_rooms()
        self.driver, self.hub, self.mesh = Workshop(site, list(items)), Hub(), LoopbackMesh()
        for item in items:
            if item.half_m > 0.15:
                self.driver.boxes += box(item.x, item.y, 2.0 * item.half_m, 2.0 * item.half_m)
        self.eyes = ToldEyes(self.driver)
        self.mesh.add(self.driver, "sim", "sim", owner=True)
        self.mesh.add(self.hub, "hub", "hub")
        self.mesh.add(QuadrupedCore(site, "dog-1", open_journal(), self.eyes), "dog-1", "robot")
        self.count = 0

    def do(self, action: str, limit_s: float = 60.0, **fields: object) -> Result:
        self.count += 1
        self.hub.send(command(f"g-{self.count}", action=action, timeout_s=limit_s, **fields))
        for _ in range(round(limit_s / 0.05) + 40):
            self.mesh.tick()
            if len(self.hub.results) == self.count:
                return self.hub.results[-1]
        raise AssertionError(f"no result: {self.hub.acks[-1]} {self.hub.reports[-1]}")


def believed(item: Item, dx: float = 0.0, dy: float = 0.0, spread_m: float = 0.2, **fields: object) -> Target:
    point = (item.x + dx, item.y + dy, item.z)
    return Target(id="thing-1", type=item.type, position_enu_m=point, spread_m=spread_m, **fields)


def apple(x: float = 3.0, y: float = 3.0) -> Item:
    return Item("Apple", x, y, 0.7)


def fridge(open: bool = False) -> Item:
    return Item("Fridge", 7.3, 1.0, 0.9, half_m=0.35, openable=True, open=open)


def test_picks_up_what_it_sees_and_not_where_it_was_believed() -> None:
    thing = apple()
    room = Room(thing)
    result = room.do("pickup", target=believed(thing, dx=-0.5, dy=0.2))
    assert (result.status, result.code, result.holding) == ("done", "ok", True)
    assert room.driver.held is thing
    assert room.driver.contacts == 0
    assert result.action_steps >= 3


def test_carries_into_the_other_room_and_puts() -> None:
    thing, cold = apple(), fridge(open=True)
    room = Room(thing, cold)
    assert room.do("pickup", target=believed(thing)).status == "done"
    result = room.do("put", target=believed(cold, dx=0.2))
    assert {(r.holding, r.holding_type) for r in room.hub.reports} == {(False, None), (True, "Apple")}
    assert (result.status, result.holding) == ("done", False)
    assert thing.inside is cold
    assert room.driver.contacts == 0
    assert True in room.eyes.carried


def test_opens_what_turns_out_closed_before_putting() -> None:
    thing, cold = apple(), fridge()
    room = Room(thing, cold)
    room.do("pickup", target=believed(thing))
    result = room.do("put", target=believed(cold))
    assert result.status == "done"
    assert "opened Fridge first" in result.reason
    assert [c.action for c in room.driver.done] == ["pickup", "put", "open", "put"]


def test_takes_out_of_a_closed_receptacle() -> None:
    cold = fridge()
    thing = Item("Apple", 7.1, 1.0, 0.9, inside=cold)
    room = Room(thing, cold)
    result = room.do("pickup", target=believed(thing, inside=believed(cold)))
    assert (result.status, result.code) == ("done", "ok")
    assert cold.open


def test_says_that_nothing_is_there_after_looking_around() -> None:
    room = Room()
    result = room.do("pickup", target=believed(apple()))
    assert (result.status, result.code) == ("failed", "not_there")
    assert 1 <= len(room.driver.done) <= 2


@pytest.mark.parametrize(("action", "code"), [("put", "not_holding"), ("slice", "precondition")], ids=["put", "slice"])
def test_an_empty_hand_fails_at_once(action: str, code: str) -> None:
    cold = fridge(open=True)
    result = Room(cold).do(action, target=believed(cold), limit_s=2.0)
    assert (result.status, result.code) == ("failed", code)


def test_a_full_hand_takes_nothing() -> None:
    first, second = apple(), apple(1.0, 3.0)
    room = Room(first, second)
    room.do("pickup", target=believed(first))
    result = room.do("pickup", target=believed(second), limit_s=2.0)
    assert (result.status, result.code, result.holding) == ("failed", "hand_full", True)


def test_opening_the_open_is_done_already() -> None:
    cold = fridge(open=True)
    result = Room(cold).do("open", target=believed(cold))
    assert (result.status, result.code) == ("done", "already")


def test_a_cancel_during_a_grasp_waits_for_the_hand() -> None:
    thing = apple(2.0, 1.0)
    room = Room(thing)
    room.hub.send(command("g-1", action="pickup", target=believed(thing)))
    while not room.driver.grips and room.driver._busy is None:
        room.mesh.tick()
    room.hub.to_ask.append(("cancel", CancelRequest(robot="dog-1", epoch=1)))
    room.mesh.run(2.0)
    assert [(r.status, r.holding) for r in room.hub.results] == [("cancelled", True)]


def test_inspects_from_near_by() -> None:
    cold = fridge(open=True)
    room = Room(cold)
    result = room.do("inspect", target=believed(cold, dx=0.3))
    assert result.status == "done"
    assert "isOpen 100%" in result.reason
    assert result.point_enu_m is not None
    assert abs(result.point_enu_m[0] - cold.x) < 0.1


def test_inspecting_what_has_gone_says_so() -> None:
    result = Room().do("inspect", target=believed(apple()))
    assert (result.status, result.code) == ("failed", "not_there")


def test_explores_the_whole_room() -> None:
    room = Room()
    result = room.do("explore", room="east", looking_for=("Apple",))
    assert result.status == "done"
    assert "no Apple seen" in result.reason
    assert room.driver.x > 4.4
    share = int(result.reason.split("%")[0].split()[-1])
    assert share >= 94


def test_explores_what_it_can_get_to_of_a_parted_room() -> None:
    room = Room()
    room.driver.boxes += box(1.35, 2.0, 0.2, 4.0)
    room.driver.x = 0.65
    result = room.do("explore", room="west", looking_for=("Apple",))
    assert result.status == "done", result.reason
    assert room.driver.contacts == 0


def test_a_room_without_a_way_in_is_said_to_be_unreachable() -> None:
    room = Room()
    room.driver.boxes += box(4.0, 2.0, 0.3, 1.2)
    result = room.do("explore", room="east", looking_for=("Apple",))
    assert (result.status, result.code) == ("failed", "unreachable")


def test_explore_ends_when_it_has_found_something() -> None:
    room, empty = Room(apple(6.0, 3.5)), Room()
    result = room.do("explore", room="east", looking_for=("Apple", "Mug"))
    assert (result.status, result.code) == ("done", "ok")
    assert "found Apple" in result.reason
    assert result.stamp_s < empty.do("explore", room="east", looking_for=("Apple",)).stamp_s


@pytest.mark.parametrize("name", sorted(SKILLS))
def test_every_skill_tells_what_it_does_and_refuses_what_it_lacks(name: str) -> None:
    card = SKILLS[name].card()
    assert len(card.doc) > 30
    assert len(card.parameters) < 2000
    given = Command(goal_id="g", epoch=0, robot="dog-1", action=name, valid_until_s=1.0, timeout_s=1.0)
    assert SKILLS[name].fault_of(given)


@pytest.mark.parametrize(
    ("reason", "code"),
    [
        ("the Fridge is closed", "closed"),
        ("the Fridge is already open", "already"),
        ("there is nothing at this point", "not_there"),
        ("Mug: out of reach by 0.4 m", "unreachable"),
        ("an Apple cannot be toggled", "precondition"),
    ],
)
def test_the_drivers_words_become_codes(reason: str, code: str) -> None:
    assert code_of(reason) == code
