"""Ways through the building: through doors and below their lintels, clear of walls and of what stands high."""

from itertools import pairwise
from math import dist

import pytest
from hypothesis import given
from hypothesis import strategies as st

from devices.drone import route
from devices.drone.airspace import NEEDED_M, Airspace, Obstacle
from devices.drone.course import Course, along_legs
from devices.drone.obstacles import Obstacles
from devices.drone.outlines import Outline
from devices.drone.route import nearest_open
from tests.devices.drone.flat import flat
from tests.devices.rooms import WALLS
from wire.messages.world import ObjectState, WorldDelta, WorldState
from wire.outline import segment_distance_m

SPACE = Airspace(flat())
place = st.tuples(st.floats(0.5, 7.5), st.floats(0.5, 3.5), st.floats(0.5, 2.0))


def to_walls_m(point) -> float:
    return min(segment_distance_m(point, a, b) for a, b in WALLS) - 0.05


def find_way(*given):
    """The whole search at once."""
    steps = route.find_way(*given)
    while True:
        try:
            next(steps)
        except StopIteration as end:
            return end.value


def test_a_long_search_lets_others_work():
    site = flat(lintel_m=2.0)
    big = site.room[0].model_copy(update={"polygon_m": ((0.0, 0.0), (40.0, 0.0), (40.0, 40.0), (0.0, 40.0))})
    wall = site.wall[0].model_copy(update={"start_m": (20.0, 1.0), "end_m": (20.0, 40.0)})
    space = Airspace(site.model_copy(update={"room": (big, site.room[1]), "wall": (wall,), "door": ()}))
    pauses = sum(1 for _ in route.find_way(space, (5.0, 35.0, 1.5), (35.0, 35.0, 1.5), 1.5))
    assert pauses > 20
    way = find_way(space, (5.0, 35.0, 1.5), (35.0, 35.0, 1.5), 1.5)
    assert any(abs(x - 20.0) < 1.0 and y < 1.0 for x, y, _ in way), "around the end of the wall"


@given(place, place)
def test_every_way_is_clear_of_walls_and_below_lintels(start, goal):
    if SPACE.fault(start) or SPACE.fault(goal):
        return
    way = find_way(SPACE, start, goal, 1.5)
    assert way is not None
    assert (way[0], way[-1]) == (start, goal)
    for at in Course(along_legs(way)).points_m:
        assert to_walls_m(at) > NEEDED_M - 0.12
        if abs(at[0] - 4.0) < 0.3:
            assert 1.5 < at[1] < 2.5, "through the door"
            assert at[2] <= 1.7 + 1e-6, "below its lintel"


def test_a_way_in_one_room_is_straight():
    assert find_way(SPACE, (1.0, 1.0, 1.5), (3.0, 3.0, 1.5), 1.5) == [(1.0, 1.0, 1.5), (3.0, 3.0, 1.5)]


def test_it_ducks_under_a_lintel_and_comes_up_behind_it():
    way = find_way(Airspace(flat(lintel_m=1.6)), (1.0, 2.0, 2.0), (7.0, 2.0, 2.0), 1.5)
    assert way is not None
    assert {round(z, 2) for _, _, z in way} == {1.3, 2.0}
    assert find_way(Airspace(flat(lintel_m=0.6)), (1.0, 2.0, 2.0), (7.0, 2.0, 2.0), 1.5) is None
    assert find_way(SPACE, (1.0, 2.0, 2.0), (1.0, 3.0, 2.0), 1.5) == [(1.0, 2.0, 2.0), (1.0, 3.0, 2.0)]


@pytest.mark.parametrize(
    ("point", "words"),
    [
        ((-1.0, 2.0, 1.5), "outside the rooms"),
        ((2.0, 3.9, 1.5), "from a wall; a drone needs 0.35 m"),
        ((2.0, 2.0, 2.4), "too high at (2.0, 2.0): at most 2.1 m"),
        ((4.0, 2.0, 1.9), "too high at (4.0, 2.0): at most 1.7 m"),
        ((2.0, 2.0, 0.1), "too low"),
        ((2.0, 2.0, 1.5), ""),
    ],
)
def test_where_it_cannot_be_is_said(point, words):
    fault = SPACE.fault(point)
    assert words in fault
    assert bool(fault) == bool(words)


def test_a_door_that_is_too_narrow_is_no_way():
    site = flat()
    door = site.door[0].model_copy(update={"start_m": (4.0, 1.8), "end_m": (4.0, 2.2)})
    wall = site.wall[0].model_copy(update={"start_m": (4.0, 0.0), "end_m": (4.0, 1.8)})
    other = site.wall[0].model_copy(update={"start_m": (4.0, 2.2), "end_m": (4.0, 4.0)})
    space = Airspace(site.model_copy(update={"door": (door,), "wall": (*site.wall[:4], wall, other)}))
    assert find_way(space, (1.0, 2.0, 1.5), (7.0, 2.0, 1.5), 1.5) is None


def test_it_goes_around_what_is_high_and_over_what_is_low():
    space = Airspace(flat())
    space.obstacles = {
        "fridge-1": Obstacle(Outline((2.0, 2.0), 0.5), 1.8),
        "sofa-1": Obstacle(Outline((6.0, 2.0), 1.2), 0.9),
    }
    way = find_way(space, (1.0, 2.0, 1.5), (3.2, 2.0, 1.5), 1.5)
    assert way is not None
    assert all(dist(p[:2], (2.0, 2.0)) > 0.7 for a, b in pairwise(way) for p in (a, midway(a, b), b))
    assert "fridge-1 stands at" in space.fault((2.2, 2.0, 1.5))
    assert find_way(space, (5.0, 2.0, 1.5), (7.0, 2.0, 1.5), 1.5) == [(5.0, 2.0, 1.5), (7.0, 2.0, 1.5)]
    beside = nearest_open(space, (2.0, 2.0, 1.5), 1.5)
    assert beside is not None
    assert not space.fault(beside)


def midway(a, b):
    return tuple((x + y) / 2.0 for x, y in zip(a, b, strict=True))


def test_it_starts_from_where_it_stands_even_beside_something():
    space = Airspace(flat())
    space.obstacles = {"fridge-1": Obstacle(Outline((1.0, 1.0), 0.5), 1.8)}
    way = find_way(space, (1.6, 1.0, 1.5), (3.0, 3.0, 1.5), 1.5)
    assert (way[0], way[-1]) == ((1.6, 1.0, 1.5), (3.0, 3.0, 1.5))


def test_it_leaves_from_within_what_is_wrongly_believed_to_stand_there():
    """Or else it would hover there until its battery is low."""
    space = Airspace(flat())
    space.obstacles = {"fridge-1": Obstacle(Outline((1.6, 1.0), 0.6), 1.8)}
    for start in ((1.6, 1.0, 1.5), (1.9, 1.2, 1.5)):
        way = find_way(space, start, (3.0, 3.0, 1.5), 1.5)
        assert way is not None
        assert (way[0], way[-1]) == (start, (3.0, 3.0, 1.5))
    over = find_way(space, (1.6, 1.0, 2.2), (3.0, 3.0, 1.5), 1.5)
    assert over is None, "it is really there, below"


def test_no_wall_is_looked_through():
    assert SPACE.in_sight((1.0, 1.0), (3.0, 3.0))
    assert not SPACE.in_sight((3.0, 1.0), (5.0, 1.0))
    assert SPACE.in_sight((3.0, 2.0), (5.0, 2.0)), "through the door"
    assert SPACE.in_sight((2.0, 2.0), (2.0, 3.95)), "what hangs on a wall"


def thing(id: str, type: str, height_m: float, confidence: float = 0.9) -> ObjectState:
    return ObjectState(
        id=id,
        type=type,
        position_enu_m=(2.0, 2.0, height_m),
        covariance_m2=(0.01, 0.0, 0.0, 0.01),
        source="cam-1",
        stamp_s=1.0,
        confidence=confidence,
    )


def test_the_hubs_world_says_what_stands_high():
    obstacles = Obstacles(flat().wall)
    known = (thing("fridge-1", "Fridge", 0.92), thing("apple-1", "Apple", 0.9), thing("fridge-2", "Fridge", 0.9, 0.1))
    obstacles.take(WorldState(seq=1, stamp_s=1.0, objects=known))
    assert obstacles.by_id.keys() == {"fridge-1"}
    assert obstacles.by_id["fridge-1"].top_m == pytest.approx(1.84, abs=0.02)
    obstacles.take(WorldDelta(seq=2, stamp_s=2.0, removed=("fridge-1",), objects=(thing("lamp-1", "FloorLamp", 0.9),)))
    assert obstacles.by_id.keys() == {"lamp-1"}
