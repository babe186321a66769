"""Generated homes: always the same for a seed, roomy, furnished, reachable, half watched."""

import hashlib
import os
import subprocess
import sys
import time
from functools import lru_cache
from itertools import combinations
from math import hypot

import pytest

from sim.boxes import body_box, boxes_overlap, wall_box
from sim.generator import make_home
from sim.generator.access import ROBOT_CLEAR_M, all_rooms_joined, home_floor, out_of_reach
from sim.generator.cctv import COVERED, coverage
from sim.models.surfaces import surfaces
from sim.scene import Scene
from wire.catalogue import PROP_FLAG, catalogue

SEEDS = (0, 1, 7, 42, 1000, 9001)


@lru_cache
def home(seed: int) -> Scene:
    return make_home(seed)


def fingerprint(scene: Scene) -> str:
    return hashlib.sha256(repr(scene).encode()).hexdigest()


def test_same_seed_same_home() -> None:
    started = time.process_time()
    again = make_home(7)
    assert time.process_time() - started < 3.0
    assert fingerprint(again) == fingerprint(home(7))
    assert len({fingerprint(home(seed)) for seed in SEEDS}) == len(SEEDS)


def test_every_process_draws_the_same_home() -> None:
    """The site file and the simulator's building are made by different processes."""
    program = "import hashlib; from sim.generator import make_home; "
    program += "print(hashlib.sha256(repr(make_home(7)).encode()).hexdigest())"
    run = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONHASHSEED": "12345"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stdout.strip() == fingerprint(home(7))


@pytest.mark.parametrize("seed", SEEDS)
def test_rooms_and_furniture(seed: int) -> None:
    scene = home(seed)
    floor_m2 = sum(
        (r.polygon_m[2][0] - r.polygon_m[0][0]) * (r.polygon_m[2][1] - r.polygon_m[0][1]) for r in scene.rooms
    )
    assert 82.0 <= floor_m2 <= 140.0
    assert 4 <= len(scene.rooms) <= 8
    assert {r.kind for r in scene.rooms} == {"Kitchen", "LivingRoom", "Bedroom", "Bathroom"}
    assert all(
        min(r.polygon_m[2][0] - r.polygon_m[0][0], r.polygon_m[2][1] - r.polygon_m[0][1]) >= 2.3 for r in scene.rooms
    )
    assert len(scene.doors) >= len(scene.rooms) - 1
    assert 40 <= len(scene.bodies) <= 70
    assert list(scene.bodies) == [b.key for b in scene.bodies.values()]
    for body in scene.bodies.values():
        assert set(body.props) == {p for p, flag in PROP_FLAG.items() if catalogue()[body.type].can(flag)}


@pytest.mark.parametrize("seed", SEEDS)
def test_nothing_overlaps(seed: int) -> None:
    scene = home(seed)
    boxes = {key: body_box(b).grown(-0.003) for key, b in scene.bodies.items()}
    for a, b in combinations(boxes, 2):
        nested = scene.bodies[b].parent == a or scene.bodies[a].parent == b
        assert nested or not boxes_overlap(boxes[a], boxes[b]), (scene.bodies[a], scene.bodies[b])
    for wall in scene.walls:
        assert not [key for key, box in boxes.items() if boxes_overlap(wall_box(wall), box)]


@pytest.mark.parametrize("seed", SEEDS)
def test_things_rest_on_their_receptacles(seed: int) -> None:
    scene = home(seed)
    for body in scene.bodies.values():
        if body.parent is None:
            continue
        below = scene.bodies[body.parent]
        tops = [below.position_m[2] + s.height_m for s in surfaces(below)]
        assert min(abs(body.position_m[2] - top) for top in tops) < 0.005
        x, y, _ = body_box(below).local(body.position_m)
        assert abs(x) <= below.size_m[0] / 2.0
        assert abs(y) <= below.size_m[1] / 2.0


@pytest.mark.parametrize("seed", SEEDS)
def test_a_robot_gets_everywhere(seed: int) -> None:
    scene = home(seed)
    floor = home_floor(scene)
    walkable = floor.walkable(needed_m=ROBOT_CLEAR_M)
    assert walkable is not None
    assert all_rooms_joined(scene, floor, walkable)
    assert not out_of_reach(scene, floor, walkable)
    assert len(scene.robot_starts) >= 6
    for (x, y), _yaw in scene.robot_starts:
        assert floor.near(walkable, (x, y)) < 0.1
        assert all(
            hypot(x - (d.start_m[0] + d.end_m[0]) / 2, y - (d.start_m[1] + d.end_m[1]) / 2) > 0.6 for d in scene.doors
        )


@pytest.mark.parametrize("seed", SEEDS)
def test_cameras_watch_half_the_floor(seed: int) -> None:
    scene = home(seed)
    assert 4 <= len(scene.cameras) <= 6
    assert COVERED[0] <= coverage(scene) <= COVERED[1]
    for pose in scene.cameras:
        assert 2.2 <= pose.position_m[2] <= 2.4
        assert 0.43 < pose.tilt_down_rad < 0.70
