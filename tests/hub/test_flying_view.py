"""A drone on the screen, on the floor map and in the terminal."""

import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import rerun.blueprint as rrb

from console.floor_map import FloorMap
from console.mesh_commands import flight_row, flight_text
from console.operate_commands import why_text
from hub.view.blueprint import blueprint
from hub.view.core import ViewCore, open_recording
from hub.view.drawing import Drawing
from hub.view.flying import way_ahead
from hub.why import why
from tests.devices.drone.flat import flat as with_drone
from tests.hub.test_flying_fleet import fleet, flying, walking
from tests.hub.test_view import flat, frame
from wire.bus import Received
from wire.loopback import LoopbackMesh


def printed(file: Path, *flyers: str) -> str:
    """Ten seconds of a drone and its camera, as a recording tells them."""
    rec = open_recording(flat(save=str(file)))
    draw = Drawing(rec, flyers)
    for n in range(20):
        told = flying("drone-1", (0.1 * n, 1.0, 1.5), (3.0, 1.0, 1.5), (3.0, 1.0, 2.1))
        draw.report(told.model_copy(update={"stamp_s": 0.5 * n}))
        draw.frame(frame(n, b"jpeg").model_copy(update={"camera": "drone-1-down"}))
    rec.flush()
    rec.disconnect()
    done = subprocess.run(
        [sys.executable, "-m", "rerun_cli", "rrd", "print", str(file)], capture_output=True, text=True
    )
    return done.stdout


def test_a_drone_is_drawn_as_one_with_its_camera_its_height_and_its_battery(tmp_path: Path) -> None:
    text = printed(tmp_path / "air.rrd", "drone-1")
    for path in ("world/robots/drone-1/rotors", "world/paths/drone-1", "flight/height_m/drone-1"):
        assert f"/{path}" in text
    assert "/flight/battery_percent/drone-1" in text
    assert "/world/cameras/drone-1-down/picture" in text
    assert "Pinhole" in text


def test_each_camera_of_a_drone_gets_a_place_on_the_screen_once_it_has_sent_a_picture(tmp_path: Path) -> None:
    file = tmp_path / "screen.rrd"
    rec = open_recording(flat(save=str(file)))
    core = ViewCore(with_drone(), rec)
    mesh = LoopbackMesh(0.05)
    mesh.add(core, "view", "view")
    mesh.tick()
    for camera in ("drone-1-down", "drone-1-left"):
        picture = frame(0, b"jpeg").model_copy(update={"camera": camera})
        core.step(0.0, [Received("camera_frame", camera, picture)])
    mesh.close()
    done = subprocess.run(
        [sys.executable, "-m", "rerun_cli", "rrd", "print", "-vvv", str(file)], capture_output=True, text=True
    )
    for view in ("drone-1-down", "drone-1-left"):
        assert f"[{view}]" in done.stdout, f"{view} has a place"
    assert "[drone-1]" not in done.stdout


def test_who_is_no_drone_is_drawn_as_before(tmp_path: Path) -> None:
    text = printed(tmp_path / "floor.rrd")
    assert "/world/robots/drone-1/body" in text
    assert "rotors" not in text
    assert "/flight/" not in text
    assert "Pinhole" not in text


def test_a_way_is_drawn_at_its_height() -> None:
    assert way_ahead(flying("drone-1", (1.0, 1.0, 1.5), (3.0, 1.0, 2.1))) == [(1.0, 1.0, 1.5), (3.0, 1.0, 2.1)]
    assert way_ahead(walking("dog-1", (1.0, 1.0), (3.0, 1.0))) == [(1.0, 1.0, 0.05), (3.0, 1.0, 0.05)]
    assert way_ahead(flying("drone-1", (1.0, 1.0, 1.5))) == []


def test_the_screen_has_a_plot_of_flight_only_where_somebody_flies() -> None:
    def plots(flight: bool) -> int:
        columns = blueprint(["cctv-1"], ["drone-1-down"], (0.0, 0.0), 5.0, flight=flight).root_container.contents
        tabs = next(part for part in columns[2].contents if isinstance(part, rrb.Tabs))
        return len(tabs.contents)

    assert plots(True) == plots(False) + 1


def test_the_floor_map_marks_a_drone_with_four_rotors(tmp_path: Path) -> None:
    def inked(robot: str) -> np.ndarray:
        picture = FloorMap(with_drone())
        picture.draw_house()
        picture.draw_paths({robot: [(1.0, 1.0), (2.0, 2.0)]})
        picture.save(tmp_path / "map.png")
        return cv2.imread(str(tmp_path / "map.png"))

    x, y = int((2.0 + 0.6) * 70), int((4.0 + 0.6 - 2.0) * 70)
    drone, dog = inked("drone-1"), inked("dog-1")
    assert tuple(drone[y, x]) == tuple(dog[y, x])
    assert tuple(drone[y, x + 8]) != tuple(dog[y, x + 8])  # between two rotors there is floor
    assert tuple(drone[y + 16, x + 10]) != tuple(drone[y, x + 20])


def test_the_terminal_tells_height_and_battery() -> None:
    world = fleet(flying("drone-1", (2.0, 2.0, 1.5), battery=0.61), walking("dog-1", (6.0, 2.0)))
    reply = why(world, "drone-1", 2.0)
    assert reply.robot == "drone-1"
    told = "drone-1: in the air, 1.5 m high, at (2.00, 2.00) m, in kitchen, battery at 61%, idle, heard 1 s ago"
    assert why_text(reply) == told
    assert why(world, "dog-1", 2.0).robot is None
    drone = next(robot for robot in world.snapshot(2.0).robots if robot.id == "drone-1")
    assert flight_text(drone) == "  1.5 m high, battery 61%"
    assert (
        flight_text(drone.model_copy(update={"airborne": False, "battery": None})) == "  on the floor, battery not told"
    )
    assert flight_text(drone.model_copy(update={"status": "lost"})) == "  its autopilot is not heard"
    assert flight_text(drone.model_copy(update={"status": "fault"})) == "  1.5 m high, battery 61%, flown by hand"
    assert flight_row(drone) == {"height_m": 1.5, "battery": drone.battery, "robot": drone.status}
    assert flight_row(None) == {}
    assert flight_text(None) == ""
