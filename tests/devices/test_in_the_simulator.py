"""A robot in simulated physics: doors, furniture, and a hand with preconditions. Walks by its lidar, without pictures."""

import pytest

from devices.goals_journal import open_journal
from devices.quadruped.core import QuadrupedCore
from sim.core import SimCore
from tests.devices.driver import Hub, command
from tests.sim.small_home import APPLE, BREAD, FRIDGE, KNIFE, LAPTOP, TABLE, make_small_home, make_small_site
from wire.loopback import LoopbackMesh
from wire.messages.command import Result, Target
from wire.messages.truth import TruthTask
from wire.site import Door, Site, Wall


class House:
    """The small home with one robot, and where its things are believed to be."""

    def __init__(self) -> None:
        self.scene = make_small_home()
        self.sim = SimCore(self._site(), self.scene, TruthTask(instruction="none", goals=()), None)
        self.hub, self.mesh, self.count = Hub(), LoopbackMesh(), 0
        self.mesh.add(self.sim, "sim", "sim", owner=True)
        self.mesh.add(self.hub, "hub", "hub")
        self.mesh.add(QuadrupedCore(self._site(), "dog-1", open_journal()), "dog-1", "robot")

    def _site(self) -> Site:
        walls = tuple(Wall(start_m=w.start_m, end_m=w.end_m) for w in self.scene.walls)
        doors = tuple(Door(id=d.id, rooms=d.rooms, start_m=d.start_m, end_m=d.end_m) for d in self.scene.doors)
        return make_small_site("dog-1").model_copy(update={"wall": walls, "door": doors})

    def target(self, key: int, inside: Target | None = None, dx: float = 0.0) -> Target:
        body = self.scene.bodies[key]
        x, y, z = body.position_m
        point = (x + dx, y, z + body.size_m[2] / 2.0)
        return Target(id=f"thing-{key}", type=body.type, position_enu_m=point, spread_m=0.1, inside=inside)

    def do(self, action: str, limit_s: float = 60.0, **fields: object) -> Result:
        self.count += 1
        self.hub.send(command(f"g-{self.count}", action=action, timeout_s=limit_s, **fields))
        for _ in range(round(limit_s / 0.05) + 40):
            self.mesh.tick()
            if len(self.hub.results) == self.count:
                return self.hub.results[-1]
        raise AssertionError(f"no result: {self.hub.acks[-1]} {self.hub.reports[-1]}")


@pytest.fixture
def house() -> House:
    return House()


def test_walks_from_room_to_room_without_touching_anything(house: House) -> None:
    for fields in ({"room": "living"}, {"point_m": (1.0, 3.0)}, {"room": "living"}):
        assert house.do("goto", **fields).status == "done"
    assert house.sim.physics.collisions == 0
    assert house.sim.physics.robots["dog-1"].motion().position_m[0] > 5.5


def test_brings_the_apple_from_the_closed_fridge_to_the_table(house: House) -> None:
    fridge = house.target(FRIDGE, dx=0.1)
    taken = house.do("pickup", target=house.target(APPLE, inside=fridge))
    assert (taken.status, taken.holding) == ("done", True)
    assert house.scene.bodies[FRIDGE].props["isOpen"]
    assert house.do("close", target=fridge).status == "done"
    assert house.do("put", target=house.target(TABLE)).status == "done"
    assert house.scene.bodies[APPLE].parent == TABLE
    assert house.sim.physics.collisions == 0


def test_slices_with_a_knife_and_switches_what_must_be_open(house: House) -> None:
    assert house.do("slice", target=house.target(BREAD)).code == "precondition"
    assert house.do("pickup", target=house.target(KNIFE)).status == "done"
    assert house.do("slice", target=house.target(BREAD)).status == "done"
    assert house.scene.bodies[BREAD].props["isSliced"]
    assert house.do("toggle_on", target=house.target(LAPTOP)).status == "done"
    assert house.scene.bodies[LAPTOP].props["isToggled"]
    assert house.sim.physics.collisions == 0


def test_the_same_commands_give_the_same_results() -> None:
    first, second = House(), House()
    for home in (first, second):
        home.do("goto", room="living")
        home.do("pickup", target=home.target(KNIFE))
    assert first.hub.results == second.hub.results
    assert first.hub.reports == second.hub.reports
