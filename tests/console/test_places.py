"""Site files: the ones that are shipped, and another port for one."""

import socket
import tomllib
from contextlib import ExitStack
from pathlib import Path

import pytest

from console.mesh_commands import device_names
from console.places import free_port, free_udp_ports, known_sites, prepare, with_value
from sim.generator import make_home
from sim.generator.site_file import Options, write_site
from wire.site import load_site


def test_the_shipped_sites_load() -> None:
    sites = {path.stem: load_site(path) for path in known_sites()}
    assert list(sites) == ["home", "webcam"]
    assert all(name == site.name for name, site in sites.items())
    assert prepare("home", 0, None, 0) in known_sites()
    webcam = sites["webcam"]
    assert webcam.clock.mode == "wall"
    assert [camera.source.partition(":")[0] for camera in webcam.camera] == ["0", "rtsp"]
    assert device_names(webcam) == {"cctv-1": "cam-1", "cctv-2": "cam-2"}


def test_the_shipped_home_is_what_the_generator_writes() -> None:
    written = tomllib.loads(write_site(make_home(5), Options(name="home", robots=2)))
    assert tomllib.loads(Path("deploy/sites/home.toml").read_text()) == written


def test_the_preferred_port_is_taken_when_it_is_free() -> None:
    port = free_port()
    assert free_port(port) == port


@pytest.mark.parametrize("toml", ["a = 1\n", "[t]\nk = 1\nm = 2\n[[u]]\nk = 3\n", "[t]\nm = 2\n", "[t]\n# k = 1\nk=4"])
def test_one_value_is_replaced_or_added(toml: str) -> None:
    before, after = tomllib.loads(toml), tomllib.loads(with_value(toml, "t", "k", "7"))
    assert after == {**before, "t": {**before.get("t", {}), "k": 7}}


def test_a_site_goes_to_another_port(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    home = Path("deploy/sites/home.toml").resolve()
    monkeypatch.chdir(tmp_path)
    moved, was = load_site(prepare(str(home), 0, 7555, 0)), load_site(home)
    assert moved.router.endpoint == "tcp/127.0.0.1:7555"
    assert moved.model_copy(update={"router": was.router, "view": was.view}) == was


def test_a_drones_ports_are_free_and_nobodys_habit() -> None:
    first = free_udp_ports(3)
    with ExitStack() as stack:
        for port in range(first, first + 3):
            stack.enter_context(socket.socket(type=socket.SOCK_DGRAM)).bind(("127.0.0.1", port))
        assert not set(range(14540, 14560)) & set(range(first, first + 3))
        again = free_udp_ports(3)
    assert not {again, again + 1, again + 2} & {first, first + 1, first + 2}
