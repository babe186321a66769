"""How a process ends: with a sentence and an exit code, or with a traceback and 70."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SITE = """
name = "nowhere"
[router]
secured = false
[[room]]
id = "room"
name = "Room"
kind = "Other"
polygon_m = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]
[[process]]
id = "hub"
role = "hub"
module = "hub"
"""


def ended(folder: Path, build: str, id: str = "hub", secured: bool = False) -> tuple[int, list[str]]:
    """Exit code and lines of log of a process whose core cannot be built, or whose arguments are wrong."""
    file = folder / "site.toml"
    file.write_text(SITE.replace("secured = false", f"secured = {str(secured).lower()}"))
    code = f"from wire.bus import CannotRun\nfrom wire.process import main\nfrom wire.site import SiteError\n{build}\n"
    code += f"main(build, argv=['--site', {str(file)!r}, '--id', {id!r}])"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=folder, env={"PYTHONPATH": str(ROOT)}, capture_output=True, text=True
    )
    return done.returncode, done.stderr.splitlines()


@pytest.mark.parametrize(
    ("build", "id", "code", "said"),
    [
        (
            "def build(site, id): raise CannotRun('no EGL here; install libegl1')",
            "hub",
            1,
            "no EGL here; install libegl1",
        ),
        ("def build(site, id): raise SiteError('robot hub is a lift')", "hub", 2, "robot hub is a lift"),
        ("def build(site, id): ...", "hup", 2, "has no process 'hup'; its processes are hub"),
    ],
)
def test_a_sentence(build: str, id: str, code: int, said: str, tmp_path: Path) -> None:
    exit_code, lines = ended(tmp_path, build, id)
    assert exit_code == code
    assert len(lines) == 1
    assert said in lines[0]
    assert " process ERROR " in lines[0]


def test_a_fault_in_the_program(tmp_path: Path) -> None:
    exit_code, lines = ended(tmp_path, "def build(site, id): return {}['x']")
    assert exit_code == 70
    assert lines[-1] == "KeyError: 'x'"
    assert "process CRITICAL a fault in the program" in lines[0]


def test_a_secured_site_without_passwords(tmp_path: Path) -> None:
    exit_code, lines = ended(tmp_path, "def build(site, id): ...", secured=True)
    assert exit_code == 1
    assert len(lines) == 1
    assert "there is no password for hub in .run/nowhere/credentials" in lines[0]
