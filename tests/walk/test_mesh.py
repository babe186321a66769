"""The mesh as real processes over loopback."""

from pathlib import Path

import pytest

from tests.walk.mesh import ROLES, WalkMesh, core_for
from wire.loopback import LoopbackMesh

pytestmark = pytest.mark.walk
CORES = ("sim", "hub", "dog-1", "dog-2")


def until(lines: list[str], before_s: float) -> list[str]:
    return [line for line in lines if line != "stopped" and float(line.split()[0]) < before_s]


def test_lockstep_over_processes_equals_the_memory_mesh(tmp_path: Path) -> None:
    with WalkMesh(tmp_path) as mesh:
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
