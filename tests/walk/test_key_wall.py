"""Ground truth reaches the evaluator and nobody else, however a rogue asks for it; without access control it would."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
import zenoh

from tests.walk.mesh import WalkMesh
from wire.bus import Received
from wire.codec import encode
from wire.letter import NO_TICK, write_stamp
from wire.link import Link, MeshError, client_config, link_for
from wire.messages.driver import VelocityCommand
from wire.messages.observation import EventLog
from wire.messages.truth import JudgeReply, JudgeRequest
from wire.node import ZenohNode, node_for

pytestmark = pytest.mark.walk
GREEDY = ("**", "r2x/**", "r2x/gt/**", "r2x/gt/state", "*/gt/*")


@contextmanager
def truthful_mesh(folder: Path, monkeypatch: pytest.MonkeyPatch, secured: bool) -> Iterator[WalkMesh]:
    monkeypatch.setenv("R2X_CREDENTIALS", str(folder / "credentials"))
    with WalkMesh(folder, mode="wall", secured=secured) as mesh:
        mesh.run_core("sim")
        mesh.run_core("dog-1")
        yield mesh


def heard_by_a_rogue(link: Link, mesh: WalkMesh) -> tuple[set[str], int]:
    """The keys a raw session hears on greedy subscriptions, and the answers it gets from the judge."""
    keys: set[str] = set()
    answers: list[object] = []
    with zenoh.open(zenoh.Config.from_json5(json.dumps(client_config(link)))) as session:
        for greedy in (*GREEDY, "r2x/event/*"):
            hear = zenoh.handlers.Callback(lambda sample: keys.add(str(sample.key_expr)), indirect=False)
            session.declare_subscriber(greedy, hear)
        mesh.wait(lambda: "r2x/event/dog-1" in keys)
        # the evaluator hears the truth meanwhile, and is answered: there is something to be heard and asked
        with node_for(mesh.site, "evaluator", "evaluator") as evaluator:
            evaluator.subscribe("truth")
            truths: list[Received] = []
            while len(truths) < 5:
                truths += [event for event in evaluator.collect(0.1) if isinstance(event, Received)]
            assert isinstance(evaluator.call("judge", JudgeRequest(), timeout_s=5.0), JudgeReply)
        for selector in ("r2x/gt/judge", "r2x/gt/**", "**"):
            question = {"payload": encode(JudgeRequest()), "attachment": write_stamp(NO_TICK, 1, "console-1")}
            got = session.get(selector, timeout=2.0, target=zenoh.QueryTarget.ALL, **question)
            answers += [reply.ok for reply in got if reply.ok is not None]
    return keys, len(answers)


def test_a_rogue_with_the_consoles_password_hears_no_truth(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with truthful_mesh(tmp_path, monkeypatch, secured=True) as mesh:
        for user in ("console", "hub"):
            keys, answers = heard_by_a_rogue(link_for(mesh.site, user), mesh)
            assert not [key for key in keys if "/gt/" in key]
            assert answers == 0


def test_without_access_control_the_same_rogue_hears_everything(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with truthful_mesh(tmp_path, monkeypatch, secured=False) as mesh:
        keys, answers = heard_by_a_rogue(link_for(mesh.site, "console"), mesh)
        assert "r2x/gt/state" in keys
        assert answers >= 1


def test_without_a_password_nobody_enters(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with truthful_mesh(tmp_path, monkeypatch, secured=True) as mesh:
        for user, password in (("", ""), ("console", "guess"), ("nobody", "x")):
            link = Link(mesh.site.router.endpoint, "r2x", user, password, timeout_s=1.0)
            with (
                pytest.raises(MeshError, match=r"cannot reach the router at tcp/127\.0\.0\.1"),
                ZenohNode(link, "console-1", "console"),
            ):
                pass


def test_passwords_are_for_their_owner_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with truthful_mesh(tmp_path, monkeypatch, secured=True) as mesh:
        files = list((tmp_path / "credentials").iterdir())
        assert {file.name for file in files} >= {"console", "evaluator", "hub", "dog-1", "users.txt"}
        assert all(file.stat().st_mode & 0o077 == 0 for file in files)
        (tmp_path / "credentials" / "console").chmod(0o644)
        with pytest.raises(MeshError, match="chmod 600"):
            link_for(mesh.site, "console-7")


def attack(mesh: WalkMesh, user: str) -> None:
    """Speak for others, ask what only the hub may ask, all with one robot's password."""
    velocity = VelocityCommand(robot="dog-7", seq=0, forward_mps=1.0, left_mps=0.0, yaw_rate_radps=0.0)
    line = EventLog(source="dog-7", seq=0, stamp_s=0.0, text="forged")
    stamp = write_stamp(NO_TICK, 1, "dog-7")
    with zenoh.open(zenoh.Config.from_json5(json.dumps(client_config(link_for(mesh.site, user))))) as session:
        session.put("r2x/robot/dog-7/velocity", encode(velocity), attachment=stamp)
        session.put("r2x/event/dog-7", encode(line), attachment=stamp)
        for _ in session.get("r2x/device/dog-1/card", timeout=2.0, payload=b"\x80", attachment=stamp):
            pass
        # what this robot may say arrives after what it may not: then the rest has had its time
        session.put(f"r2x/event/{user}", encode(line.model_copy(update={"text": "my own"})), attachment=stamp)
        mesh.wait(lambda: any(f"event/{user}" in entry and "my own" in entry for entry in mesh.diary("hub")))


@pytest.mark.parametrize("secured", [True, False])
def test_one_robot_cannot_speak_for_another(secured: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with truthful_mesh(tmp_path, monkeypatch, secured) as mesh:
        mesh.run_core("hub")
        mesh.wait(lambda: any("event/dog-1" in entry for entry in mesh.diary("hub")))
        mesh.wait(lambda: any("velocity/dog-1" in entry for entry in mesh.diary("sim")))
        cards_before = sum("? card/dog-1" in entry for entry in mesh.diary("dog-1"))
        attack(mesh, "dog-2")

        def came_through() -> list[bool]:
            return [
                any("velocity/dog-7" in entry for entry in mesh.diary("sim")),
                any("event/dog-7" in entry for entry in mesh.diary("hub")),
                sum("? card/dog-1" in entry for entry in mesh.diary("dog-1")) > cards_before,
            ]

        if secured:
            assert came_through() == [False, False, False]
        else:
            mesh.wait(lambda: all(came_through()))
