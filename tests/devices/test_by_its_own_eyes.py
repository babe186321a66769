"""The whole chain of one robot: drawn pictures, the shipped detector, a search, an inspection. No belief is given."""

import tomllib

from devices.goals_journal import open_journal
from devices.quadruped.core import QuadrupedCore
from devices.quadruped.eyes import PictureEyes
from devices.vision.detector import EmbeddedDetector
from sim.core import build
from sim.generator.home import make_home
from sim.generator.site_file import Options, write_site
from tests.devices.driver import Hub, command
from wire.loopback import LoopbackMesh
from wire.messages.command import Target
from wire.site import parse_site


def test_finds_the_fridge_and_inspects_it() -> None:
    site = parse_site(tomllib.loads(write_site(make_home(1), Options(robots=1, cctv=False))), "home-1")
    hub, mesh = Hub(), LoopbackMesh()
    mesh.add(build(site, "sim"), "sim", "sim", owner=True)
    mesh.add(hub, "hub", "hub")
    eyes = PictureEyes(site, "dog-1", EmbeddedDetector())
    mesh.add(QuadrupedCore(site, "dog-1", open_journal(), eyes), "dog-1", "robot")
    hub.send(command("g-1", action="explore", room="kitchen", looking_for=("Fridge",), timeout_s=90.0))
    while not hub.results and mesh.now_s < 100.0:
        mesh.tick()
    found = hub.results[0]
    assert (found.status, found.code) == ("done", "ok")
    assert found.point_enu_m is not None
    target = Target(id="fridge-1", type="Fridge", position_enu_m=found.point_enu_m, spread_m=0.2, room="kitchen")
    hub.send(command("g-2", action="inspect", target=target, timeout_s=60.0))
    while len(hub.results) < 2 and mesh.now_s < 200.0:
        mesh.tick()
    assert hub.results[1].status == "done"
    assert "saw Fridge isOpen" in hub.results[1].reason
    mesh.close()
