"""A recording survives a kill, and a core that is handed it again says the same again."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.wire.cores import Clockwork, Gossip, Walker
from wire.loopback import LoopbackMesh
from wire.recorder import replay_into
from wire.recording import Record, RecordingError, RecordingWriter, read_recording


def recorded(file: Path, seconds: float = 2.0) -> Clockwork:
    sim = Clockwork()
    with RecordingWriter(file) as writer:
        mesh = LoopbackMesh(recorder=writer.write)
        mesh.add(sim, "sim", "sim", owner=True)
        mesh.add(Gossip(), "hub", "hub")
        mesh.add(Walker(), "dog-1", "robot")
        mesh.run(seconds)
        mesh.close()
    return sim


def test_a_core_says_again_what_it_said(tmp_path: Path) -> None:
    before = recorded(tmp_path / "r")
    records = list(read_recording(tmp_path / "r"))
    again = Clockwork()
    said = replay_into(again, "sim", "sim", [r for r in records if r.sender != "sim"], 0.05)
    assert again.lines == before.lines
    assert len(again.lines) > 30
    assert said == [r for r in records if r.sender == "sim"]


def test_half_a_record_at_the_end_is_left_out_and_then_cut_off(tmp_path: Path) -> None:
    file = tmp_path / "r"
    recorded(file, 0.2)
    whole = list(read_recording(file))
    size = file.stat().st_size
    for lost in (1, 3, 10):
        with file.open("r+b") as data:
            data.truncate(size - lost)
        assert list(read_recording(file)) == whole[:-1]
    with RecordingWriter(file) as writer:
        writer.write(*whole[-1])
    assert list(read_recording(file)) == whole


@given(cut=st.integers(0, 3000))
def test_any_cut_leaves_a_beginning(cut: int, tmp_path_factory: pytest.TempPathFactory) -> None:
    file = tmp_path_factory.mktemp("cut") / "r"
    rows = [Record(i * 0.05, "event/hub", "hub", i, bytes(i)) for i in range(30)]
    with RecordingWriter(file) as writer:
        for row in rows:
            writer.write(*row)
    data = file.read_bytes()
    file.write_bytes(data[: len(data) - cut % (len(data) - 16)])
    found = list(read_recording(file))
    assert found == rows[: len(found)]


def test_another_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "x").write_text("something else entirely")
    with pytest.raises(RecordingError, match="is no recording"):
        list(read_recording(tmp_path / "x"))
    with pytest.raises(RecordingError, match="is no recording"), RecordingWriter(tmp_path / "x"):
        pass
    assert (tmp_path / "x").read_text() == "something else entirely"
