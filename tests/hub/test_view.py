"""What the view draws, keeps and leaves out, in real recordings."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
import rerun as rr

from console.places import free_port
from console.viewer import rerun_program
from hub.view.core import open_recording
from hub.view.drawing import Drawing
from hub.view.house import draw_house
from wire.messages.command import RobotReport
from wire.messages.driver import CameraFrame
from wire.messages.world import RobotState, WorldDelta
from wire.site import Site, parse_site

ROOT = Path(__file__).parents[2]
PICTURE_BYTES = 50_000


@pytest.fixture(autouse=True)
def _own_importers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "meta_path", list(sys.meta_path))


def flat(**view: object) -> Site:
    """A single room and nobody in it."""
    room = {"id": "room", "name": "Room", "kind": "Other", "polygon_m": ((0.0, 0.0), (4.0, 0.0), (4.0, 3.0))}
    process = {"id": "view", "role": "view", "module": "hub.view"}
    return parse_site(
        {"name": "flat", "room": (room,), "process": (process,), "view": {"grpc_port": free_port(), **view}}, "here"
    )


def frame(seq: int, jpeg: bytes) -> CameraFrame:
    return CameraFrame(
        camera="cctv-1", seq=seq, stamp_s=seq * 0.5, width_px=640, height_px=480, focal_px=400.0,
        position_enu_m=(0.0, 0.0, 2.0), yaw_rad=0.0, tilt_down_rad=0.5, jpeg=jpeg,
    )  # fmt: skip


def report(seq: int, x_m: float) -> RobotReport:
    return RobotReport(
        robot="dog-1", seq=seq, stamp_s=seq * 0.5, position_enu_m=(x_m, 0.0, 0.0), yaw_rad=0.0, status="idle"
    )


def recorded_bytes(file: Path, frames: Iterator[CameraFrame], reports: Iterator[RobotReport]) -> int:
    rec = open_recording(flat(save=str(file)))
    draw = Drawing(rec)
    for one in frames:
        draw.frame(one)
        rec.flush()  # else the same picture twice in one chunk is compressed to one
    for one in reports:
        draw.report(one)
    rec.flush()
    rec.disconnect()
    return file.stat().st_size


def test_what_does_not_change_is_drawn_once_in_a_while(tmp_path: Path) -> None:
    same = os.urandom(PICTURE_BYTES)
    still = recorded_bytes(
        tmp_path / "still.rrd", (frame(n, same) for n in range(100)), (report(n, 0.0) for n in range(100))
    )
    moving = recorded_bytes(
        tmp_path / "moving.rrd",
        (frame(n, os.urandom(PICTURE_BYTES)) for n in range(100)),
        (report(n, 0.2 * n) for n in range(100)),
    )
    assert 4 * PICTURE_BYTES < still < 8 * PICTURE_BYTES  # 50 s, every ten seconds
    assert moving > 99 * PICTURE_BYTES


def test_a_clock_that_was_set_back_is_drawn(tmp_path: Path) -> None:
    pictures = [os.urandom(PICTURE_BYTES) for _ in range(6)]
    seqs = (100, 101, 102, 0, 1, 2)
    size = recorded_bytes(
        tmp_path / "twice.rrd", (frame(n, jpeg) for n, jpeg in zip(seqs, pictures, strict=True)), iter(())
    )
    assert size > 6 * PICTURE_BYTES


def test_pandas_stays_out() -> None:
    code = """
import sys
from pathlib import Path
from hub.view.blueprint import blueprint
from hub.view.light import do_without_pandas
import rerun as rr
do_without_pandas()
blueprint(["cctv-1"], ["dog-1"], (0.0, 0.0), 5.0)
rr.Points3D([(1.0, 2.0, 3.0)], labels=["apple"])
rr.GraphNodes(node_ids=["a"], positions=[(1.0, 2.0)])
assert "pandas" not in sys.modules
"""
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.walk
def test_a_browser_that_joins_late_sees_the_house(tmp_path: Path) -> None:
    site = flat(memory_limit="1MiB")
    rec = open_recording(site)
    draw_house(rec, site)
    draw = Drawing(rec)
    for n in range(100):
        draw.frame(frame(n, os.urandom(PICTURE_BYTES)))
        rec.flush()
    rec.log("log/view", rr.TextLog("that was all"))
    rec.flush()
    text = seen_by_a_viewer(site.view.grpc_port, tmp_path / "late.rrd")
    rec.disconnect()
    assert "/world/house/walls" in text
    assert "/world/house/floors/room" in text
    assert 1 <= text.count("/world/cameras/cctv-1/picture") < 60  # of a hundred, the newest


def seen_by_a_viewer(port: int, file: Path) -> str:
    """What a viewer that connects now is told, as text."""
    rerun = [sys.executable, "-m", "rerun_cli"]
    viewer = subprocess.Popen(
        [*rerun, f"rerun+http://127.0.0.1:{port}/proxy", "--save", str(file)],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
    )  # fmt: skip
    try:
        for _ in range(300):
            shown = subprocess.run([*rerun, "rrd", "print", str(file)], capture_output=True, text=True).stdout
            if "/log/view" in shown:
                return shown
            time.sleep(0.2)
    finally:
        os.killpg(viewer.pid, signal.SIGKILL)
        viewer.wait()
    raise AssertionError(f"the viewer was not told everything: {shown[-500:]}")


def test_a_robot_that_lets_another_pass_is_not_said_to_hold_something(tmp_path: Path) -> None:
    rec = open_recording(flat(save=str(tmp_path / "one.rrd")))
    draw = Drawing(rec)
    robot = RobotState(
        id="dog-1", kind="quadruped", position_enu_m=(1.0, 1.0, 0.0), yaw_deg=0.0, status="holding", stamp_s=1.0
    )
    draw.world(WorldDelta(seq=1, stamp_s=1.0, robots=(robot,)))
    rec.disconnect()
    text = subprocess.run(
        [rerun_program(), "rrd", "print", "-vvv", str(tmp_path / "one.rrd")], capture_output=True, text=True
    ).stdout
    assert "gives way" in text
    assert "holding" not in text
