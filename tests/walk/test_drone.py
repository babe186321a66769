"""A drone's process, MAVSDK and all, against the simulated autopilot, each a real process."""

import time
from math import dist
from pathlib import Path

import pytest

from tests.walk.drone_mesh import START_M, DroneMesh

pytestmark = pytest.mark.walk
FIRMWARES = ("ardupilot", "px4")


@pytest.mark.parametrize("firmware", FIRMWARES)
def test_it_flies_through_a_door_and_comes_home(tmp_path: Path, firmware: str) -> None:
    with DroneMesh(tmp_path, firmware) as mesh:
        mesh.ready()
        assert not mesh.report.airborne
        assert dist(mesh.report.position_enu_m[:2], START_M) < 0.3
        mesh.done("g-1", "take_off", params={"height_m": 1.2})
        mesh.done("g-2", "goto", point_m=(6.0, 1.0), params={"height_m": 1.4, "yaw_deg": 0.0})
        assert dist(mesh.report.position_enu_m, (6.0, 1.0, 1.4)) < 0.3
        assert mesh.report.airborne
        crossing = [r.position_enu_m[1] for r in mesh.reports if 3.8 < r.position_enu_m[0] < 4.2]
        assert crossing
        assert all(1.7 < y < 2.3 for y in crossing), "through the door's middle"
        assert mesh.report.battery is not None
        mesh.done("g-3", "return_home")
        mesh.until(lambda: not mesh.report.airborne)
        assert dist(mesh.report.position_enu_m[:2], START_M) < 0.5
        mesh.done("g-4", "take_off")
        mesh.done("g-5", "land")


@pytest.mark.parametrize("firmware", FIRMWARES)
def test_a_cancelled_flight_ends_in_hover(tmp_path: Path, firmware: str) -> None:
    with DroneMesh(tmp_path, firmware) as mesh:
        mesh.ready()
        mesh.give("g-1", "goto", point_m=(7.0, 3.0))
        mesh.until(lambda: mesh.report.position_enu_m[0] > 2.5)
        assert mesh.report.path_m
        mesh.cancel("g-1")
        assert mesh.ended("g-1").status == "cancelled"
        mesh.until(lambda: stands(mesh))
        assert mesh.report.airborne
        assert mesh.report.position_enu_m[2] > 1.0
        assert mesh.report.position_enu_m[0] < 6.0
        mesh.done("g-2", "land")


def stands(mesh: DroneMesh) -> bool:
    """For a second by now."""
    return len(mesh.reports) > 10 and all(
        dist(r.velocity_enu_mps or (9.0, 0.0, 0.0), (0.0, 0.0, 0.0)) < 0.15 for r in mesh.reports[-10:]
    )


def test_without_its_hub_it_hovers_and_then_lands(tmp_path: Path) -> None:
    with DroneMesh(tmp_path) as mesh:
        mesh.ready()
        mesh.give("g-1", "goto", point_m=(7.0, 3.0))
        mesh.until(lambda: mesh.report.position_enu_m[0] > 2.5)
        mesh.there = False
        mesh.until(lambda: mesh.report.status == "lost")
        mesh.until(lambda: stands(mesh))
        assert mesh.report.airborne
        mesh.until(lambda: not mesh.report.airborne)
        mesh.there = True
        result = mesh.ended("g-1")
        assert (result.status, result.code) == ("failed", "lost_hub")
        assert "without the hub" in result.reason
        mesh.until(lambda: mesh.report.status == "idle")


def test_a_hub_that_comes_back_in_time_has_its_goal_done(tmp_path: Path) -> None:
    with DroneMesh(tmp_path) as mesh:
        mesh.ready()
        mesh.give("g-1", "goto", point_m=(6.0, 2.0))
        mesh.until(lambda: mesh.report.position_enu_m[0] > 2.5)
        mesh.there = False
        mesh.until(lambda: mesh.report.status == "lost")
        mesh.there = True
        result = mesh.ended("g-1")
        assert result.status == "done", result.reason


def test_an_autopilot_that_dies_is_lost_and_comes_back(tmp_path: Path) -> None:
    with DroneMesh(tmp_path) as mesh:
        mesh.ready()
        mesh.kill("autopilot")
        died_s = time.time()
        mesh.until(lambda: mesh.report.status == "lost")
        assert mesh.report.stamp_s - died_s < 2.0
        mesh.give("g-1", "take_off")
        refused = mesh.ended("g-1")
        assert refused.status == "failed"
        assert "not heard" in refused.reason
        mesh.start_autopilot()
        mesh.until(lambda: mesh.report.status == "idle", 20.0)
        mesh.done("g-2", "take_off")
        mesh.done("g-3", "land")


def test_what_the_vehicle_cannot_do_is_said(tmp_path: Path) -> None:
    with DroneMesh(tmp_path) as mesh:
        mesh.ready()
        for goal, fields, words in (
            ("g-1", {"point_m": (9.0, 2.0)}, "outside the rooms"),
            ("g-2", {"point_m": (3.9, 3.5)}, "from a wall"),
            ("g-3", {"point_m": (2.0, 2.0), "params": {"height_m": 2.4}}, "too high"),
        ):
            result = mesh.do(goal, "goto", **fields)
            assert result.status == "failed"
            assert words in result.reason
            assert not mesh.report.airborne
        assert "on the ground" in mesh.do("g-4", "hold").reason


@pytest.mark.parametrize("firmware", FIRMWARES)
def test_curves_orbits_and_looks(tmp_path: Path, firmware: str) -> None:
    points = ((1.0, 1.0, 1.2), (2.5, 1.0, 1.5), (3.0, 2.5, 1.8), (1.5, 3.0, 1.2))
    with DroneMesh(tmp_path, firmware) as mesh:
        mesh.ready()
        mesh.done("g-1", "follow_path", params={"way_m": "; ".join(" ".join(map(str, p)) for p in points)})
        flown = [r.position_enu_m for r in mesh.reports]
        assert all(min(dist(p, f) for f in flown) < 0.3 for p in points), "through its points"
        mesh.reports.clear()
        mesh.done("g-2", "orbit", point_m=(2.0, 2.0), params={"radius_m": 1.0, "turns": 0.5})
        looked = mesh.do("g-3", "look_at", point_m=(6.0, 2.0))
        assert looked.status == "done", looked.reason
        assert "taken" in looked.reason
        assert 0.7 < dist(mesh.report.position_enu_m[:2], (6.0, 2.0)) < 1.3
        mesh.done("g-4", "land")


def test_a_process_that_is_stopped_lands_the_drone(tmp_path: Path) -> None:
    with DroneMesh(tmp_path) as mesh:
        mesh.ready()
        mesh.done("g-1", "take_off")
        assert mesh.end("drone-1") == 0
        mesh.reports.clear()
        mesh.start_drone()
        mesh.until(lambda: bool(mesh.reports) and not mesh.report.airborne)


def test_a_process_that_is_killed_in_flight_can_land_it_afterwards(tmp_path: Path) -> None:
    with DroneMesh(tmp_path) as mesh:
        mesh.ready()
        mesh.give("g-1", "goto", point_m=(7.0, 3.0))
        mesh.until(lambda: mesh.report.position_enu_m[0] > 2.5)
        mesh.kill("drone-1")
        mesh.lines.clear()
        mesh.reports.clear()
        mesh.start_drone()
        assert mesh.ended("g-1").status == "interrupted"
        mesh.ready()
        assert mesh.report.airborne
        mesh.done("g-2", "land")
