"""`doctor`: what is missing is named with the command that brings it, and the exit code says whether anything is."""

import json
import socket
from pathlib import Path
from typing import Any

import pytest

from console import doctor
from console.app import run
from console.doctor import Check, checks
from console.doctor_commands import doctor_document, doctor_text
from planners.model import OllamaModel
from planners.modelled import modelled
from planners.planner import PLANNERS
from tests.ollama_double.at_hand import stand_in
from tests.planners.scripted_model import VisitPlanner
from tests.planners.toy import site
from wire.planner_table import PlannerChoice


@pytest.fixture(autouse=True)
def visits(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(PLANNERS, "visits", modelled(VisitPlanner))


def found(choice: PlannerChoice, load: bool = False) -> dict[str, Check]:
    return {check.name: check for check in checks(site().model_copy(update={"planner": choice}), load)}


def named(**table: Any) -> PlannerChoice:
    return PlannerChoice.model_validate({"name": "visits", "model": "qwen3:8b", **table})


def test_a_server_that_does_not_run() -> None:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        host = f"http://127.0.0.1:{probe.getsockname()[1]}"
    rows = found(named(host=host))
    assert rows["server"].state == "missing"
    assert rows["server"].remedy == f"OLLAMA_HOST={host} ollama serve"
    assert "model" not in rows
    assert doctor._serve("http://127.0.0.1:11434") == "ollama serve"
    assert doctor._serve("http://box:11434") == "on the machine of http://box:11434: ollama serve"


def test_a_model_that_was_not_pulled() -> None:
    with stand_in(table={"name": "visits", "model": "phi4:14b"}) as (_, choice):
        rows = found(choice)
    assert rows["server"].state == "ok"
    assert "qwen3:8b" in rows["server"].text
    assert (rows["model"].state, rows["model"].remedy) == ("missing", "ollama pull phi4:14b")


def test_a_model_that_is_there_and_the_context_that_it_really_has() -> None:
    with stand_in(largest_context=2048, table={"name": "visits"}) as (_, choice):
        rows = found(choice)
        assert rows["model"].text == "qwen3:8b: a stand-in without a model that claims completion, thinking, tools"
        assert rows["context"].text == "8192 tokens will be asked for; the model is loaded when the planner starts"
        model = OllamaModel(choice)
        model.start()
        assert model.loading_is_over(20.0)
        assert found(choice)["context"].state == "without", "another program may have loaded it"
        rows = found(choice, load=True)
    assert rows["context"].state == "missing"
    assert "the server gave 2048 tokens, planner.num_ctx asks for 8192" in rows["context"].text
    assert rows["context"].remedy.endswith("planner.num_ctx = 2048")


def test_a_context_that_the_model_cannot_have() -> None:
    with stand_in(table={"name": "visits", "num_ctx": 65536}) as (_, choice):
        row = found(choice)["context"]
    assert (row.state, row.remedy) == ("missing", "set planner.num_ctx = 40960")


def test_a_model_for_pictures_must_see() -> None:
    with stand_in(table={"name": "scripted", "vision": "qwen2.5vl:7b"}) as (_, choice):
        rows = found(choice)
        assert rows["planner"].text == "scripted, with qwen2.5vl:7b for pictures"
        assert rows["model"].text.endswith("claims completion, vision")
        blind = found(choice.model_copy(update={"vision": "llama3.1:8b"}))["model"]
    assert (blind.state, blind.remedy) == ("missing", "set planner.vision to a model with the capability `vision`")


def test_a_server_that_hangs_or_is_none() -> None:
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen()
        host = f"http://127.0.0.1:{silent.getsockname()[1]}"
        rows = {c.name: c for c in doctor.server_checks(named(host=host), ["qwen3:8b"], load=False)}
    assert rows["server"].state == "missing"
    assert "no whole answer within 5 s" in rows["server"].text


def test_planners_without_a_server() -> None:
    assert found(PlannerChoice())["planner"].text == "scripted needs no language model"
    assert "server" not in found(PlannerChoice())
    kept = found(named(replies="only"))
    assert "asks no server" in kept["planner"].text
    assert "server" not in kept
    assert found(PlannerChoice(name="oracle"))["planner"].state == "missing"


def test_ports_that_are_taken() -> None:
    with socket.socket() as holder:
        holder.bind(("127.0.0.1", 0))
        holder.listen()
        port = holder.getsockname()[1]
        here = site()
        router = here.process[0].model_copy(update={"id": "router", "role": "router"})
        here = here.model_copy(
            update={
                "process": (router,),
                "router": here.router.model_copy(update={"endpoint": f"tcp/127.0.0.1:{port}"}),
            }
        )
        row = doctor._ports(here)
    assert row.state == "missing"
    assert f"port {port} (router.endpoint) is taken by" in row.text
    assert row.remedy.startswith("stop that, or take other ports")


def test_the_site_of_a_running_mesh_has_its_own_ports(monkeypatch: pytest.MonkeyPatch) -> None:
    text = "port 7447 (router.endpoint) is taken by the mesh of toy, which runs from .run/toy; stop that, or take other"
    monkeypatch.setattr(doctor, "taken_ports", lambda _: text)
    assert doctor._ports(site()).state == "ok"


def test_the_text_and_the_document() -> None:
    rows = [Check("python", "ok", "3.11.7"), Check("model", "missing", "m: not there", "ollama pull m")]
    said = doctor_text(site(), rows)
    assert said.splitlines()[2:] == [
        "  MISSING  model    m: not there",
        "                    -> ollama pull m",
        "missing: model",
    ]
    document = doctor_document(site(), rows)
    assert not document["ok"]
    assert document["checks"][1]["remedy"] == "ollama pull m"


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "_opengl", lambda _: Check("opengl", "ok", "as another test sees"))
    text = Path("deploy/sites/home.toml").read_text().replace("endpoint", "#", 1)
    file = tmp_path / "home.toml"
    file.write_text(text.replace('name = "scripted"', 'name = "oracle"'))
    assert run(["doctor", str(file), "--json"]) == 1
    document = json.loads(capsys.readouterr().out)
    (planner,) = [row for row in document["checks"] if row["name"] == "planner"]
    assert planner["remedy"].startswith("planner.name: scripted")
    assert run(["doctor", str(tmp_path / "none.toml")]) == 2
