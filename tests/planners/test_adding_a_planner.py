"""The page docs/add-a-planner.md, word for word."""

import importlib
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

import planners
from planners.planner import PLANNERS
from tests.pages import ROOT, blocks, files
from tests.planners.executor import run
from tests.planners.test_core import check_row
from tests.planners.test_tasks import furnished, hub_agrees
from tests.planners.toy import ROOMS, site
from wire.site import PlannerChoice

PAGE = "add-a-planner.md"


@pytest.fixture
def rounds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """The page's planner, in the table by its row; its name."""
    ((name, text),) = files(PAGE).items()
    (tmp_path / name).parent.mkdir()
    (tmp_path / name).write_text(text)
    monkeypatch.setattr(planners, "__path__", [*planners.__path__, str(tmp_path / "planners")])
    (row,) = (text for text in blocks(PAGE, "python") if text.startswith("PLANNERS"))
    (imported,) = (text for text in blocks(PAGE, "python") if text.startswith("from planners."))
    table = importlib.import_module("planners.planner")
    names = dict(vars(table))
    exec(imported + row, names)
    for key, make in names["PLANNERS"].items():
        monkeypatch.setitem(PLANNERS, key, make)
    yield "rounds"
    monkeypatch.delitem(sys.modules, "planners.rounds")


def test_the_planner_of_the_page_passes_what_every_row_must(rounds: str) -> None:
    check_row(rounds)


def test_the_planner_of_the_page_sends_robots_into_every_room(rounds: str) -> None:
    house = furnished(1, ())
    reply, goals, _ = run(house, PLANNERS[rounds](site()), "good night", check=hub_agrees)
    assert reply.plan is not None
    assert len(goals) == len(ROOMS)
    assert house.searched == {id for id, _, _ in ROOMS}


def test_the_table_of_the_site_file_names_it() -> None:
    (table,) = blocks(PAGE, "toml")
    assert PlannerChoice.model_validate(tomllib.loads(table)["planner"]).name == "rounds"


@pytest.mark.parametrize("rule", [("check",), ("format", "--check")], ids=lambda rule: rule[0])
def test_the_code_of_the_page_keeps_the_rules_of_the_tree(rule: tuple[str, ...]) -> None:
    ((name, text),) = files(PAGE).items()
    command = [sys.executable, "-m", "ruff", *rule, "--no-cache", "--stdin-filename", name, "-"]
    done = subprocess.run(command, input=text, capture_output=True, text=True, cwd=ROOT)
    assert done.returncode == 0, done.stdout + done.stderr
