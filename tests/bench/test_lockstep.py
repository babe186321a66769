"""What the measurement of the lockstep makes of a generated home's site file."""

from pathlib import Path

import pytest

from bench.lockstep import with_tours, without_vision
from sim.generator import make_home
from sim.generator.site_file import Options, write_site
from wire.site import load_site


def test_robots_without_vision_are_sent_from_room_to_room(tmp_path: Path) -> None:
    file = tmp_path / "site.toml"
    file.write_text(with_tours(without_vision(write_site(make_home(7), Options()))))
    modules = [process.module for process in load_site(file).process]
    assert modules.count("bench.tour") == 1
    assert "planners" not in modules
    assert "hub.view" not in modules
    with pytest.raises(ValueError, match='no process with module = "planners"'):
        with_tours(file.read_text())
