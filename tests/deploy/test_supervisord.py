"""The rendered supervisor configuration survives awkward paths and says which processes run here."""

import configparser
import shlex
from pathlib import Path

from deploy.supervisord import Places, render
from wire.site import parse_site

SITE = {
    "name": "mini",
    "room": [{"id": "hall", "name": "hall", "kind": "Other", "polygon_m": [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]]}],
    "process": [
        {"id": "router", "role": "router", "module": "wire.router"},
        {"id": "view", "role": "view", "module": "hub.view", "args": ["--a b"]},
        {"id": "cctv-1", "role": "cctv", "module": "devices.cctv", "host": "edge-box", "autostart": False},
    ],
}


def _render(run: Path, host: str = "localhost") -> configparser.RawConfigParser:
    places = Places(run / "site.toml", run, run / "s.sock", run / "credentials", "/usr/bin/python3")
    parser = configparser.RawConfigParser()
    parser.read_string(render(parse_site(SITE, "test"), places, host))
    return parser


def test_only_this_hosts_processes_are_run_here() -> None:
    assert {"program:router", "program:view"} == {s for s in _render(Path("/r")).sections() if "program" in s}
    assert "program:cctv-1" in _render(Path("/r"), "edge-box").sections()


def test_paths_with_spaces_and_percents_stay_whole() -> None:
    run = Path("/tmp/my run 100%")
    config = _render(run)
    words = shlex.split(config["program:view"]["command"].replace("%%", "%"))
    assert words[words.index("--site") + 1] == str(run / "site.toml")
    assert words[-1] == "--a b"
    assert config["supervisord"]["logfile"] == str(run / "supervisord.log").replace("%", "%%")


def test_a_wrong_configuration_is_not_restarted() -> None:
    program = _render(Path("/r"))["program:router"]
    assert program["autorestart"] == "unexpected"
    assert program["exitcodes"] == "2"
