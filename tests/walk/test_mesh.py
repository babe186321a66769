"""The mesh as real processes over loopback."""

import signal
import subprocess
import sys
from pathlib import Path
from threading import Thread

import pytest

from tests.walk.mesh import ROLES, WalkMesh, core_for
from wire.bus import Event, Presence, Received, Reply
from wire.link import MeshError, link_for
from wire.loopback import LoopbackMesh
from wire.messages.clock import Health
from wire.messages.command import CardRequest, DeviceCard
from wire.messages.observation import EventLog
from wire.node import ZenohNode, node_for
from wire.recording import read_recording

pytestmark = pytest.mark.walk
CORES = ("sim", "hub", "dog-1", "dog-2")


def until(lines: list[str], before_s: float) -> list[str]:
    return [line for line in lines if line != "stopped" and float(line.split()[0]) < before_s]


def test_lockstep_over_processes_equals_the_memory_mesh(tmp_path: Path) -> None:
    with WalkMesh(tmp_path, secured=True) as mesh:
        for id in reversed(CORES):
            mesh.run_core(id)
        mesh.wait(lambda: bool(mesh.diary("sim")) and float(mesh.diary("sim")[-1].split()[0]) > 5.0)
        assert [mesh.end(id) for id in CORES] == [0, 0, 0, 0]
        walked = {id: until(mesh.diary(id), 5.0) for id in CORES}
    memory = LoopbackMesh()
    cores = {id: core_for(ROLES[id]) for id in CORES}
    for id in CORES:
        memory.add(cores[id], id, ROLES[id], owner=id == "sim")
    memory.run(5.5)
    for id in CORES:
        assert walked[id] == until(cores[id].lines, 5.0)
        assert len(walked[id]) > 50 or id.startswith("dog")


def at_rest(mesh: WalkMesh) -> None:
    for id in CORES:
        mesh.run_core(id)
    mesh.wait(lambda: len(mesh.diary("sim")) > 10)


def boot_id(mesh: WalkMesh, process: str) -> str:
    """What a process calls its run in its heartbeat."""
    with node_for(mesh.site, "console-1", "console") as console:
        console.subscribe("health", process)
        heard: list[Event] = []
        mesh.wait(lambda: bool(heard.extend(console.collect(0.1)) or heard))
    assert isinstance(heard[0], Received)
    assert isinstance(heard[0].message, Health)
    return heard[0].message.boot_id


def test_kill_9_is_noticed_and_time_goes_on(tmp_path: Path) -> None:
    with WalkMesh(tmp_path) as mesh:
        at_rest(mesh)
        before = boot_id(mesh, "dog-2")
        mesh.processes["dog-2"].kill()
        mesh.processes["dog-2"].wait()
        mesh.wait(lambda: any("dog-2 went" in line for line in mesh.diary("hub")))
        steps = len(mesh.diary("sim"))
        mesh.wait(lambda: len(mesh.diary("sim")) > steps + 20)
        mesh.run_core("dog-2")
        mesh.wait(lambda: sum("dog-2 came" in line for line in mesh.diary("hub")) == 2)
        mesh.wait(lambda: "velocity/dog-2" in mesh.diary("sim")[-1])
        assert boot_id(mesh, "dog-2") != before, "who knew it before notices that it is another run"


def test_a_frozen_process_is_noticed_and_comes_back(tmp_path: Path) -> None:
    with WalkMesh(tmp_path) as mesh:
        at_rest(mesh)
        mesh.processes["dog-1"].send_signal(signal.SIGSTOP)
        mesh.wait(lambda: any("dog-1 went" in line for line in mesh.diary("hub")))
        mesh.processes["dog-1"].send_signal(signal.SIGCONT)
        mesh.wait(lambda: sum("dog-1 came" in line for line in mesh.diary("hub")) == 2)
        mesh.wait(lambda: any("velocity/dog-1" in line for line in mesh.diary("sim")[-2:]))


def test_a_router_that_is_killed_and_comes_back(tmp_path: Path) -> None:
    with WalkMesh(tmp_path) as mesh:
        at_rest(mesh)
        mesh.processes["router"].kill()
        mesh.processes["router"].wait()
        mesh.run("wire.router", "router")
        steps = len(mesh.diary("sim"))
        mesh.wait(lambda: len(mesh.diary("sim")) > steps + 40)
        assert all(mesh.processes[id].poll() is None for id in CORES)


def test_who_was_never_heard_to_come_is_found_by_counting(tmp_path: Path) -> None:
    with WalkMesh(tmp_path, mode="wall", secured=True) as mesh:
        mesh.run_core("dog-1")
        with node_for(mesh.site, "hub", "hub", credentials=tmp_path / "credentials") as node:
            came: list[object] = []

            def hears() -> bool:
                node.recount()
                came.extend(node.collect(0.2))
                return Presence("dog-1", True) in came

            mesh.wait(hears)
            assert len(came) == len(set(came)), "who is counted twice came once"


def test_a_late_question_is_answered_as_unknown(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with WalkMesh(tmp_path, mode="wall") as mesh:
        mesh.run_core("dog-1")
        with node_for(mesh.site, "hub", "hub") as hub:
            hub.watch_presence()
            mesh.wait(lambda: Presence("dog-1", True) in hub.collect(0.1))
            mesh.processes["dog-1"].send_signal(signal.SIGSTOP)
            ask = hub.ask("card", CardRequest(), "dog-1", timeout_s=0.3)
            replies: list[Reply] = []
            mesh.wait(lambda: bool(replies.extend(e for e in hub.collect(0.1) if isinstance(e, Reply)) or replies))
            assert replies == [Reply(ask, "card", "dog-1", None, "no answer from card/dog-1 in 0.3 s")]
            mesh.processes["dog-1"].send_signal(signal.SIGCONT)
            hub.ask("card", CardRequest(), "dog-1", timeout_s=5.0)
            mesh.wait(lambda: bool(replies.extend(e for e in hub.collect(0.1) if isinstance(e, Reply)) or replies[1:]))
            assert len(replies) == 2, "the answer that came too late is not handed out"
            assert isinstance(replies[1].message, DeviceCard)


def test_nothing_is_lost_in_a_burst(tmp_path: Path) -> None:
    with WalkMesh(tmp_path, mode="wall") as mesh:
        with node_for(mesh.site, "hub", "hub") as hub, node_for(mesh.site, "dog-1", "robot") as dog:
            hub.subscribe("event", "dog-1")
            numbers: list[object] = []
            sender = Thread(target=send_events, args=(dog, 50_000))
            sender.start()
            while len(numbers) < 50_000:
                events = hub.collect(2.0)
                assert events, f"{len(numbers)} of 50000 came"
                numbers += [
                    e.message.seq for e in events if isinstance(e, Received) and isinstance(e.message, EventLog)
                ]
            sender.join()
        assert numbers == list(range(50_000))


def send_events(node: ZenohNode, count: int) -> None:
    for seq in range(count):
        node.publish("event", EventLog(source="dog-1", seq=seq, stamp_s=0.0, text="a small thing happened"), "dog-1")


def sentence(mesh: WalkMesh, module: str, id: str, *args: str) -> tuple[int, str]:
    """Exit code and the one line of log of a process that cannot start."""
    process = mesh.run(module, id, *args)
    code = process.wait(30)
    lines = mesh.log(id).splitlines()
    assert len(lines) == 1, lines
    return code, lines[0]


def test_what_cannot_start_says_why_in_one_sentence(tmp_path: Path) -> None:
    mesh = WalkMesh(tmp_path)
    nowhere = ("--diary", str(tmp_path / "d"))
    code, text = sentence(mesh, "tests.walk.mesh", "hub-9", *nowhere)
    assert code == 2
    assert "site walk has no process 'hub-9'; its processes are sim, hub, dog-1, dog-2" in text
    with mesh:
        code, text = sentence(mesh, "wire.router", "router-2")
        assert code == 2
        assert f"cannot listen on 127.0.0.1:{mesh.port}" in text
        assert "router.endpoint in the site file" in text
    mesh.site_file.write_text(mesh.site_file.read_text().replace("speed", "sped"))
    code, text = sentence(mesh, "tests.walk.mesh", "dog-2", *nowhere)
    assert code == 2
    assert "clock.sped" in text


def test_a_mesh_that_is_not_there(tmp_path: Path) -> None:
    mesh = WalkMesh(tmp_path)
    link = link_for(mesh.site, "hub", timeout_s=0.5)
    with pytest.raises(MeshError, match=f"hub cannot reach the router at tcp/127.0.0.1:{mesh.port} within 0.5 s"):
        ZenohNode(link, "hub", "hub").__enter__()


def test_no_orphans(tmp_path: Path) -> None:
    with WalkMesh(tmp_path, mode="wall") as mesh:
        start = f"import subprocess, sys; subprocess.Popen({mesh.command('tests.walk.mesh', 'hub', '--diary', 'd')!r})"
        parent = subprocess.Popen(
            [sys.executable, "-c", f"{start}.wait()"], cwd=tmp_path, env=mesh.environment, stderr=subprocess.PIPE
        )
        with node_for(mesh.site, "evaluator", "evaluator") as looker:
            looker.watch_presence()
            mesh.wait(lambda: Presence("hub", True) in looker.collect(0.1))
            parent.kill()
            mesh.wait(lambda: Presence("hub", False) in looker.collect(0.1))
        assert b"hub stopped" in parent.communicate()[1]


def test_a_killed_recorder_leaves_a_good_recording(tmp_path: Path) -> None:
    out = tmp_path / "recording"
    with WalkMesh(tmp_path, secured=True) as mesh:
        recorder = mesh.run("wire.recorder", "recorder", "--out", str(out))
        mesh.wait(lambda: "recording into" in mesh.log("recorder"))
        for id in CORES:
            mesh.run_core(id)
        mesh.wait(lambda: out.stat().st_size > 100_000)
        recorder.kill()
        recorder.wait()
        records = list(read_recording(out))
    assert {"event/dog-1", "event/dog-2", "robot/dog-1/progress"} <= {record.key for record in records}
    assert not any(record.key.startswith("gt/") for record in records)
    lines = [record for record in records if record.key == "event/dog-1"]
    ticks = [record.tick for record in lines]
    assert ticks == list(range(ticks[0], ticks[0] + len(ticks))), "not one is missing"
