"""Rules of this tree that no linter knows: sizes, names, words, recipes with help, loopback everywhere."""

import ast
import json
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("wire", "hub", "planners", "devices", "sim", "console", "deploy", "bench")
SOURCES = sorted(p for name in PACKAGES for p in (ROOT / name).rglob("*.py"))
TESTS = sorted((ROOT / "tests").rglob("*.py"))
MAX_FILE_LINES = 300
MAX_FUNCTION_LINES = 60
VAGUE_NAMES = {"utils", "util", "helpers", "helper", "manager", "base", "common", "misc"}


def _name(path: Path) -> str:
    return str(path.relative_to(ROOT))


@pytest.mark.parametrize("path", SOURCES + TESTS, ids=_name)
def test_file_is_short_and_says_its_job(path: Path) -> None:
    text = path.read_text()
    assert len(text.splitlines()) <= MAX_FILE_LINES
    assert path.stem not in VAGUE_NAMES
    if text.strip():
        assert ast.get_docstring(ast.parse(text)), "a module docstring says its one job"


@pytest.mark.parametrize("path", SOURCES, ids=_name)
def test_functions_are_short_and_swallow_nothing(path: Path) -> None:
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            length = (node.end_lineno or node.lineno) - node.lineno + 1
            assert length <= MAX_FUNCTION_LINES, f"{node.name} has {length} lines"
        if isinstance(node, ast.ExceptHandler):
            names = {n.id for n in ast.walk(node.type) if isinstance(n, ast.Name)} if node.type else {"everything"}
            assert not names & {"Exception", "BaseException", "everything"}, f"line {node.lineno} catches {names}"


@pytest.mark.parametrize("path", SOURCES, ids=_name)
def test_nothing_is_left_for_later_and_no_simulator_branches(path: Path) -> None:
    text = path.read_text()
    assert not re.search(r"\b(TODO|FIXME|XXX|HACK)\b|NotImplementedError", text)
    if path.relative_to(ROOT).parts[0] != "sim":
        assert not re.search(r"\bif (not )?(is_|in_|use_)?sim(ulat\w*)?\b", text, re.IGNORECASE)


def test_nothing_serves_beyond_loopback() -> None:
    for path in SOURCES:
        assert "0.0.0.0" not in path.read_text(), _name(path)


def test_every_recipe_has_help_and_a_group() -> None:
    just = ROOT / ".tools" / "bin" / "just"
    if not just.exists():
        pytest.skip("just is fetched by ./justw, which was not used to start this run")
    dump = json.loads(subprocess.run([just, "--dump", "--dump-format", "json"], capture_output=True, cwd=ROOT).stdout)
    for name, recipe in dump["recipes"].items():
        if not recipe["private"]:
            assert recipe["doc"], f"recipe {name} has no line of help"
            assert any("group" in a for a in recipe["attributes"]), f"recipe {name} is in no group"


def test_the_tree_speaks_of_itself_alone() -> None:
    listed = subprocess.run(["git", "ls-files", "-z"], capture_output=True, text=True, cwd=ROOT).stdout.split("\0")
    hosts = "|".join(("py" + r"pi\.org", "pythonho" + "sted", r"registry\.npm"))
    word = re.compile(r"(?<![\w.])/(work|root|home)/[a-z.]|\.\./sha" + r"red|" + hosts, re.IGNORECASE)
    for name in filter(None, listed):
        path = ROOT / name
        if name == "LICENSE" or not path.is_file():
            continue
        try:
            text = path.read_text()
        except UnicodeDecodeError:
            continue
        assert not word.search(text), f"{name}: {word.search(text)}"
