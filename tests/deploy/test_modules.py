"""A module that is not there is named before anything is started."""

import pytest

from deploy.modules import missing_modules
from tests.deploy.test_supervisord import SITE
from wire.site import parse_site


def _site(module: str, host: str = "localhost") -> str:
    row = {"id": "dog-1", "role": "robot", "module": module, "host": host}
    return missing_modules(parse_site({**SITE, "process": [*SITE["process"], row]}, "test"))


@pytest.mark.parametrize("module", ["devices.quadruped", "sim", "wire.router"])
def test_what_is_there_is_not_named(module: str) -> None:
    assert _site(module) == ""


def test_a_typo_is_told_with_what_may_be_meant(monkeypatch, tmp_path) -> None:
    monkeypatch.chdir(tmp_path)
    assert _site("devices.quadrupde") == (
        "process dog-1: there is no module devices.quadrupde; is devices.quadruped meant?"
    )
    assert "nosuch.thing; make it, or correct `module`" in _site("nosuch.thing")
    assert "devices.vision" in _site("devices.vision"), "a package that cannot be run"


def test_what_runs_elsewhere_is_there() -> None:
    assert _site("devices.quadrupde", "edge-box") == ""
