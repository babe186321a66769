"""Whatever bytes stand on whatever key: they are refused, counted and named, and the rest goes on."""

import json
import random
import re
from pathlib import Path

import msgpack
import pytest
import zenoh

from tests.walk.mesh import WalkMesh
from wire.codec import SMALL_BYTES, encode
from wire.letter import NO_TICK, write_stamp
from wire.link import client_config, link_for
from wire.messages.observation import EventLog

pytestmark = pytest.mark.walk
STAMP = write_stamp(NO_TICK, 1, "dog-9")
GOOD = encode(EventLog(source="dog-9", seq=0, stamp_s=0.0, text="hello"))


def garbage(rng: random.Random) -> list[tuple[str, bytes, bytes | None]]:
    """(key, payload, stamp) of messages that are all wrong in some way."""
    wrong = [
        ("r2x/event/*", GOOD, STAMP),
        ("r2x/event/**", GOOD, STAMP),
        ("r2x/event/Dog", GOOD, STAMP),
        ("r2x/event/dog-9", GOOD, None),
        ("r2x/event/dog-9", GOOD, b"short"),
        ("r2x/event/dog-9", b"\x91" * 100_000, STAMP),
        ("r2x/event/dog-9", bytes(SMALL_BYTES + 1), STAMP),
        ("r2x/event/dog-9", GOOD[:-1], STAMP),
        ("r2x/event/dog-9", msgpack.packb({**msgpack.unpackb(GOOD), "extra": 1}), STAMP),
    ]
    return wrong + [("r2x/event/dog-9", rng.randbytes(rng.randrange(60)), STAMP) for _ in range(200)]


@pytest.mark.parametrize("mode", ["wall", "lockstep"])
def test_garbage_changes_nothing(mode: str, tmp_path: Path) -> None:
    with WalkMesh(tmp_path, mode=mode) as mesh:
        for id in ("sim", "hub", "dog-1", "dog-2"):
            mesh.run_core(id)
        mesh.wait(lambda: any("event/dog-1" in line for line in mesh.diary("hub")))
        config = client_config(link_for(mesh.site, "console-1"))
        bad = garbage(random.Random(3))
        with zenoh.open(zenoh.Config.from_json5(json.dumps(config))) as session:
            for key, payload, stamp in bad:
                session.put(key, payload, attachment=stamp, congestion_control=zenoh.CongestionControl.BLOCK)
            for payload in (b"", b"\xc1"):
                answers = list(session.get("r2x/device/dog-1/card", payload=payload, attachment=STAMP, timeout=5.0))
                assert [answer.ok for answer in answers] == [None], "an error says what is wrong with the question"
            session.put("r2x/event/dog-9", GOOD, attachment=STAMP)
        mesh.wait(lambda: any("event/dog-9" in line and "hello" in line for line in mesh.diary("hub")))
        assert sum("/dog-9" in line for line in mesh.diary("hub")) == 1
        numbers = [int(n) for n in re.findall(r"refused message number (\d+)", mesh.log("hub"))]
        assert numbers == [2**i for i in range(8)], f"{len(bad)} refused, few lines"
        assert "dog-9" in mesh.log("hub")
        lines = len(mesh.diary("hub"))
        mesh.wait(lambda: len(mesh.diary("hub")) > lines + 20)
        assert all(mesh.processes[id].poll() is None for id in mesh.processes)
