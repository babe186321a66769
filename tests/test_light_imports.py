"""No process imports what its role does not need: `sys.modules` of each, right after its imports."""

import os
import re
import subprocess
import sys
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
EXTRAS = PROJECT["project"]["optional-dependencies"]
HEAVY = {"numpy", "cv2", "scipy", "pybullet", "moderngl", "rerun", "pyarrow", "torch", "onnx", "onnxruntime", "lark", "typer",
         "rich", "supervisor", "matplotlib", "ollama", "httpx", "anyio", "mavsdk", "pymavlink"}  # fmt: skip
MAY_IMPORT = {
    "wire.router": set(),
    "wire.recorder": set(),
    "hub": {"numpy"},
    "planners": {"lark", "rapidfuzz"},
    "devices.quadruped": set(),
    "hub.view": {"numpy", "rerun", "pyarrow"},
    "sim": {"numpy", "cv2", "pybullet", "moderngl"},
}
DEVICES = sorted(path.parent.name for path in (ROOT / "devices").glob("*/__main__.py"))


def packages_of(extra: str) -> set[str]:
    """Names of the packages that an extra brings, those of the extras in it too."""
    found: set[str] = set()
    for requirement in EXTRAS[extra]:
        name, inner = re.match(r"([\w.-]+)(?:\[([\w,]+)\])?", requirement).groups()
        found |= {p for e in inner.split(",") for p in packages_of(e)} if name == "r2x" else {name.lower()}
    return found


def imports_heavy(module: str) -> set[str]:
    main = f"{module}.__main__" if (ROOT / module.replace(".", "/") / "__main__.py").exists() else module
    code = f"import sys, {main}; print(*sorted(set(m.split('.')[0] for m in sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, timeout=60)
    assert done.returncode == 0, done.stderr
    return set(done.stdout.split()) & HEAVY


@pytest.mark.parametrize("module", sorted(MAY_IMPORT))
def test_a_role_imports_only_what_it_needs(module: str) -> None:
    assert imports_heavy(module) <= MAY_IMPORT[module]


def test_only_a_planner_that_has_a_model_imports_the_client_of_model_servers(tmp_path: Path) -> None:
    code = f"""
import os, sys
from pathlib import Path
os.environ["R2X_STATE"] = r"{tmp_path}"
from planners.core import build
from planners.modelled import modelled
from planners.opening import model_of, vision_of
from wire.planner_table import PlannerChoice
from wire.site import load_site
site = load_site(Path("deploy/sites/home.toml"))
build(site, "planner", "scripted")
offline = site.model_copy(update={{"planner": PlannerChoice(name="goals", replies="only")}})
model_of(offline)
assert vision_of(site) is None
print(*(name in sys.modules for name in ("ollama", "httpx")))
model_of(site)
print(*(name in sys.modules for name in ("ollama", "httpx")))
"""
    environment = {**os.environ, "OLLAMA_HOST": "127.0.0.1:9"}
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, timeout=60, env=environment
    )
    assert done.stdout == "False False\nTrue True\n", done.stderr


def test_a_robot_without_vision_is_built_without_numpy(tmp_path: Path) -> None:
    """And walks without it: its map takes in a sweep, and it finds a place to stand and a way there."""
    code = f"""
import sys
from pathlib import Path
from devices.quadruped import path, places
from devices.quadruped.__main__ import build
from devices.quadruped.map import FloorMap
from wire.site import load_site
site = load_site(Path("deploy/sites/home.toml"))
build(site, site.robot[0].id, Path(r"{tmp_path}") / "goals.sqlite", no_vision=True).stop()
floor, here = FloorMap(site), site.robot[0].start_m
floor.mark([(here[0] + 0.9, here[1])], 0.0)
assert path.search(floor, path.prices(floor, here), here, places.near_point(floor, here))
print("numpy" in sys.modules)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, timeout=60)
    assert done.stdout == "False\n", done.stderr


@pytest.mark.parametrize("device", DEVICES)
def test_a_device_imports_only_what_its_extra_names(device: str) -> None:
    assert device in EXTRAS, f"pyproject.toml has no extra {device}: name the packages that devices/{device} needs"
    (everything,) = EXTRAS["all"]
    assert device in re.findall(r"\w+", everything), f"the extra `all` in pyproject.toml leaves {device} out"
    packages = packages_of(device)
    from_extra = {m for m, names in packages_distributions().items() if packages & {name.lower() for name in names}}
    assert imports_heavy(f"devices.{device}") <= from_extra


def test_the_contract_of_independence_names_every_device() -> None:
    contracts = PROJECT["tool"]["importlinter"]["contracts"]
    (devices,) = [c for c in contracts if c["type"] == "independence"]
    assert sorted(devices["modules"]) == [f"devices.{device}" for device in DEVICES]
