"""A supervised mesh of real processes: up, status, restart after a crash, no orphans, clear faults."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from deploy.launch import LaunchError, Mesh
from wire.site import Site, load_site

pytestmark = pytest.mark.walk
MINI = """\
name = "mini"
[router]
endpoint = "tcp/127.0.0.1:{port}"
[clock]
mode = "wall"
[[room]]
id = "hall"
name = "hall"
kind = "Other"
polygon_m = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]]
[[process]]
id = "router"
role = "router"
module = "wire.router"
[[process]]
id = "planner"
role = "planner"
module = "planners"
"""


def _wait(condition: Callable[[], bool], limit_s: float = 15.0) -> None:
    deadline = time.monotonic() + limit_s
    while not condition():
        assert time.monotonic() < deadline, "did not happen in time"
        time.sleep(0.05)


def _alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return "Z" not in Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]


@pytest.fixture
def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@pytest.fixture
def mesh(tmp_path: Path, free_port: int) -> Iterator[tuple[Mesh, Site]]:
    mesh = Mesh(tmp_path)
    mesh.site_file.write_text(MINI.format(port=free_port))
    yield mesh, load_site(mesh.site_file)
    if mesh.is_up():
        mesh.stop()


def _running(mesh: Mesh) -> bool:
    return all(p.state == "RUNNING" for p in mesh.processes())


def test_crashed_process_comes_back_and_stop_leaves_nothing(mesh: tuple[Mesh, Site]) -> None:
    launch, site = mesh
    launch.start(site)
    _wait(lambda: _running(launch))
    _wait(lambda: "planner is on the mesh" in (launch.log_dir / "planner.log").read_text())
    before = {p.id: p.pid for p in launch.processes()}
    os.kill(before["planner"], signal.SIGKILL)
    _wait(lambda: _running(launch) and {p.id: p.pid for p in launch.processes()}["planner"] != before["planner"])
    _wait(lambda: (launch.log_dir / "planner.log").read_text().count("planner is on the mesh") == 2)
    pids = [p.pid for p in launch.processes()]
    ended = launch.stop()
    assert {p.id: p.exit_code for p in ended} == {"router": 0, "planner": 0}
    assert not any(_alive(pid) for pid in pids)


def test_killed_supervisor_leaves_no_orphans_and_is_said_to_be_gone(mesh: tuple[Mesh, Site], tmp_path: Path) -> None:
    launch, site = mesh
    launch.start(site)
    _wait(lambda: _running(launch))
    pids = [p.pid for p in launch.processes()]
    os.kill(int((launch.run_dir / "supervisord.pid").read_text()), signal.SIGKILL)
    _wait(lambda: not any(_alive(pid) for pid in pids))
    (tmp_path / ".run").mkdir()
    (tmp_path / ".run" / "current").symlink_to(tmp_path)
    for words in (("status",), ("task", "turn off the tv"), ("why", "tv"), ("stop",), ("view",)):
        assert f"no mesh runs from {tmp_path} any more; `justw up` starts one" in _console(tmp_path, *words).stderr


def test_a_supervisor_killed_while_its_processes_load_leaves_no_orphans(mesh: tuple[Mesh, Site]) -> None:
    launch, site = mesh
    launch.start(site)
    _wait(lambda: all(p.pid for p in launch.processes()))
    pids = [p.pid for p in launch.processes()]
    os.kill(int((launch.run_dir / "supervisord.pid").read_text()), signal.SIGKILL)
    _wait(lambda: not any(_alive(pid) for pid in pids))


def test_starting_twice_and_asking_a_mesh_that_is_not_there_are_refused(mesh: tuple[Mesh, Site]) -> None:
    launch, site = mesh
    with pytest.raises(LaunchError, match="justw up"):
        launch.processes()
    launch.start(site)
    with pytest.raises(LaunchError, match="already runs"):
        launch.start(site)
    with pytest.raises(LaunchError, match=r"no process 'nobody'.*planner, router"):
        launch.restart("nobody")


def _console(tmp_path: Path, *words: str) -> subprocess.CompletedProcess[str]:
    root = str(Path(__file__).resolve().parents[2])
    return subprocess.run(
        [sys.executable, "-m", "console", *words],
        cwd=tmp_path, capture_output=True, text=True, timeout=90, env={**os.environ, "PYTHONPATH": root},
    )  # fmt: skip


def test_a_port_in_use_is_named_and_everything_is_stopped_again(tmp_path: Path, free_port: int) -> None:
    file = tmp_path / "mini.toml"
    file.write_text(MINI.format(port=free_port))
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", free_port))
        taken.listen()
        done = _console(tmp_path, "up", str(file))
    assert done.returncode == 1
    assert str(free_port) in done.stderr
    assert "Traceback" not in done.stderr
    assert not Mesh(tmp_path / ".run" / "mini").is_up()


def test_a_typo_in_the_site_file_is_one_sentence_with_its_place(tmp_path: Path, free_port: int) -> None:
    file = tmp_path / "mini.toml"
    file.write_text(MINI.format(port=free_port).replace('name = "hall"', 'nmae = "hall"'))
    done = _console(tmp_path, "up", str(file))
    assert done.returncode == 2
    assert "room.0.nmae" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_second_mesh_that_fails_does_not_hide_the_first(tmp_path: Path, free_port: int) -> None:
    first, second = tmp_path / "first.toml", tmp_path / "second.toml"
    first.write_text(MINI.format(port=free_port))
    second.write_text(MINI.format(port=free_port).replace('name = "mini"', 'name = "other"'))
    try:
        assert _console(tmp_path, "up", str(first)).returncode == 0
        again = _console(tmp_path, "up", str(first))
        assert "already runs" in again.stderr
        done = _console(tmp_path, "up", str(second))
        assert done.returncode == 1
        assert f"port {free_port} (router.endpoint) is taken by the mesh of mini" in done.stderr
        assert "--port" in done.stderr
        assert "planner" in _console(tmp_path, "status").stdout
        for words in (("task", ""), ("task", "x" * 3000), ("why", "x" * 300), ("cancel", "A B")):
            done = _console(tmp_path, *words, "--json")
            assert done.returncode == 1
            assert json.loads(done.stdout)["ok"] is False
            assert "Traceback" not in done.stderr
        for words in (("task",), ("tusk", "x"), ("up", "--seed", "x"), ("up", "--sed", "3"), ("down", "mini")):
            done = _console(tmp_path, *words, "--json")
            assert done.returncode == 2
            assert "--help` tells more" in json.loads(done.stdout)["error"]
            assert not done.stderr
    finally:
        done = _console(tmp_path, "down")
    assert "stopped 2 processes" in done.stdout
    assert not Mesh(tmp_path / ".run" / "mini").is_up()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_start_leaves_nothing(tmp_path: Path, free_port: int, number: signal.Signals) -> None:
    file = tmp_path / "mini.toml"
    # nobody is there for the second process to announce: the command waits
    file.write_text(MINI.format(port=free_port).replace('module = "planners"', 'module = "wire.router"'))
    root = str(Path(__file__).resolve().parents[2])
    command = [sys.executable, "-m", "console", "up", str(file)]
    with subprocess.Popen(command, cwd=tmp_path, env={**os.environ, "PYTHONPATH": root}) as up:
        mesh = Mesh(tmp_path / ".run" / "mini")
        _wait(mesh.is_up)
        up.send_signal(number)
        assert up.wait(30) != 0
    assert not mesh.is_up()


def test_seeds_and_homes_that_cannot_be_are_refused_in_one_sentence(tmp_path: Path) -> None:
    for words in (
        ("demo-seeds", "--seeds", "abc"),
        ("demo-seeds", "--seeds", "5-3"),
        ("up", "--seed", "-1"),
        ("up", "--seed", "x"),
        ("up", "--drones", "9"),
        ("up", "."),
        ("demo", "--out", "/proc/nowhere"),
        ("view",),
        ("record", "run.rrd"),
    ):
        done = _console(tmp_path, *words)
        assert done.returncode != 0
        assert done.stderr.count("error: ") == 1, done.stderr
        assert "Traceback" not in done.stderr
    assert not list((tmp_path / ".run").glob("home*")), "nothing is left of a home that cannot be"
