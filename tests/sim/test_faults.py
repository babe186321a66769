"""What goes wrong on purpose goes wrong as told, and only that."""

import pytest

from tests.sim.small_mesh import Listener, mesh_maker
from wire.codec import decode
from wire.messages.driver import (
    CameraFrame,
    DeviceReport,
)
from wire.site import SiteError


@pytest.fixture
def make_mesh():
    yield from mesh_maker()


def test_smart_appliances_report_and_a_fault_turns_the_report_round(make_mesh):
    def reports(**sim):
        sent = []
        mesh, core = make_mesh(Listener("dog-1"), recorder=lambda *row: sent.append(row), smart_appliances=True, **sim)
        mesh.run(1.0)
        next(b for b in core.scene.bodies.values() if b.type == "Television").props["isToggled"] = True
        mesh.run(1.0)
        rows = [
            decode(DeviceReport, payload) for _, key, _, _, payload in sent if key == "appliance/television-1/report"
        ]
        return [row.props["isToggled"] for row in rows]

    assert reports() == [0.0, 1.0]
    wrong = [{"device": "television-1", "kind": "wrong_state", "prop": "isToggled"}]
    assert reports(fault=wrong) == [1.0, 0.0]
    with pytest.raises(SiteError, match=r"this home has no television-2; it has .*television-1"):
        reports(fault=[{"device": "television-2", "kind": "wrong_state"}])


def test_lost_and_late_pictures(make_mesh):
    def stamps(**sim):
        dog = Listener("dog-1")
        mesh, _ = make_mesh(dog, renderer=True, **sim)
        heard = []
        for tick in range(120):
            before = len(dog.heard)
            mesh.tick()
            heard += [(tick * 0.05, m.stamp_s) for m in dog.heard[before:] if isinstance(m, CameraFrame)]
        return heard

    healthy = stamps()
    assert len(healthy) == 12
    lost = stamps(fault=[{"device": "dog-1", "kind": "frame_loss", "probability": 0.5}])
    assert 2 <= len(lost) <= 10
    assert lost == stamps(fault=[{"device": "dog-1", "kind": "frame_loss", "probability": 0.5}])
    late = stamps(fault=[{"device": "dog-1", "kind": "delay", "delay_s": 0.3}])
    assert all(at_s - stamp_s == pytest.approx(0.3, abs=0.051) for at_s, stamp_s in late)
    assert all(at_s - stamp_s == pytest.approx(0.0, abs=1e-6) for at_s, stamp_s in healthy)
