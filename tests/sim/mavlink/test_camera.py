"""The camera and the gimbal: what they say of themselves, pictures and turns on command."""

import math

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.mavlink.camera import CAMERA
from sim.mavlink.endpoint import Aboard, Endpoint
from sim.mavlink.gimbal import GIMBAL
from tests.sim.mavlink.bed import Bed

NAN = math.nan


def test_components_show_themselves(bed):
    client = bed.client()
    client.wait("HEARTBEAT")
    bed.advance(1.5)
    kinds = {m.get_srcComponent(): m.type for m in client.all("HEARTBEAT")}
    assert kinds == {1: mav.MAV_TYPE_QUADROTOR, CAMERA: mav.MAV_TYPE_CAMERA, GIMBAL: mav.MAV_TYPE_GIMBAL}


def test_camera_says_what_it_is(bed):
    client = bed.client()
    names = {
        259: "CAMERA_INFORMATION",
        260: "CAMERA_SETTINGS",
        261: "STORAGE_INFORMATION",
        262: "CAMERA_CAPTURE_STATUS",
    }
    for number, name in names.items():
        assert client.command(512, number, target=(1, CAMERA)) == 0
        assert client.wait(name).get_srcComponent() == CAMERA
    assert client.command(512, 259, target=(1, 1)) == mav.MAV_RESULT_UNSUPPORTED
    assert client.command(521, 1, target=(1, CAMERA)) == 0
    assert client.wait("CAMERA_INFORMATION").resolution_h > 0
    assert client.command(400, 1, target=(1, CAMERA)) == mav.MAV_RESULT_UNSUPPORTED


def test_one_picture_and_a_series(bed):
    client = bed.client()
    bed.advance(2.0)
    assert client.command(2000, 0, 0, 1, 1, target=(1, CAMERA)) == 0
    assert client.wait("CAMERA_IMAGE_CAPTURED").image_index == 1
    bed.advance(1.0)
    assert len(client.all("CAMERA_IMAGE_CAPTURED")) == 1
    assert client.command(2000, 0, 0.5, 0, target=(1, 0)) == 0
    bed.advance(2.1)
    assert len(client.all("CAMERA_IMAGE_CAPTURED")) == 5
    assert client.command(2001, target=(1, CAMERA)) == 0
    client.forget()
    bed.advance(1.0)
    assert not client.all("CAMERA_IMAGE_CAPTURED")
    for bad in (math.inf, -2, 1e30):
        assert client.command(2000, 0, 0, bad, target=(1, CAMERA)) == mav.MAV_RESULT_DENIED


def level(client) -> float:
    assert client.command(512, 260, target=(1, CAMERA)) == 0
    return float(client.wait("CAMERA_SETTINGS").zoomLevel)


@pytest.mark.parametrize(
    ("kind", "value", "part"),
    [(0, 1, 10), (0, -1, 0), (1, 1, 100), (2, 40, 40), (3, 7.5, 50), (3, 99, 100), (4, 63.0, 0), (4, 20, 82.6)],
)
def test_zoom_goes_where_it_is_sent_and_says_when_it_is_there(bed, kind, value, part):
    client = bed.client()
    bed.advance(1.0)
    assert level(client) == 0
    assert client.command(531, kind, value, target=(1, CAMERA)) == 0
    if part:
        client.wait("CAMERA_SETTINGS", 6.0, lambda m: abs(m.zoomLevel - part) < 1)
    assert level(client) == pytest.approx(part, abs=1)


def test_zoom_on_and_on_stops_where_it_is_told(bed):
    client = bed.client()
    bed.advance(1.0)
    wide = client.command(512, 271, target=(1, CAMERA)) == 0 and client.wait("CAMERA_FOV_STATUS").hfov
    assert client.command(531, 1, 1, target=(1, CAMERA)) == 0
    bed.advance(1.0)
    assert client.command(531, 1, 0, target=(1, CAMERA)) == 0
    stopped = level(client)
    assert 10 < stopped < 40
    bed.advance(1.0)
    assert level(client) == pytest.approx(stopped, abs=1)
    assert client.command(512, 271, target=(1, CAMERA)) == 0
    assert client.wait("CAMERA_FOV_STATUS").hfov < wide - 5
    for kind, value in ((5, 1), (NAN, 1), (2, 101), (2, NAN), (1, 0.5), (3, -1), (4, 0), (0, math.inf)):
        assert client.command(531, kind, value, target=(1, CAMERA)) == mav.MAV_RESULT_DENIED


def test_it_claims_what_it_does(bed):
    client = bed.client()
    assert client.command(512, 259, target=(1, CAMERA)) == 0
    flags = client.wait("CAMERA_INFORMATION").flags
    there = mav.CAMERA_CAP_FLAGS_CAPTURE_IMAGE | mav.CAMERA_CAP_FLAGS_HAS_MODES | mav.CAMERA_CAP_FLAGS_HAS_BASIC_ZOOM
    assert flags == there | mav.CAMERA_CAP_FLAGS_HAS_IMAGE_SURVEY_MODE
    for absent in (532, 2500, 2502, 2004):  # focus, video, a stream of it, tracking
        assert client.command(absent, 1, target=(1, CAMERA)) == mav.MAV_RESULT_UNSUPPORTED


@pytest.mark.parametrize("target", [1, CAMERA])
def test_the_trigger_has_an_interval_and_a_switch(bed, target):
    client = bed.client()
    bed.advance(2.0)
    assert client.command(214, 500, target=(1, target)) == 0
    bed.advance(2.2)
    assert 4 <= len(client.all("CAMERA_IMAGE_CAPTURED")) <= 5
    assert client.command(2003, 0, target=(1, target)) == 0
    bed.advance(1.2)
    assert not client.all("CAMERA_IMAGE_CAPTURED")
    assert client.command(2003, 1, target=(1, target)) == 0
    bed.advance(0.2)
    assert client.all("CAMERA_IMAGE_CAPTURED")
    assert client.command(214, 0, target=(1, target)) == 0
    bed.advance(1.2)
    assert not client.all("CAMERA_IMAGE_CAPTURED")
    for wrong in (-5, math.inf, 1e12):
        assert client.command(214, wrong, target=(1, target)) == mav.MAV_RESULT_DENIED


def test_gimbal_turns_and_says_so(bed):
    client = bed.client()
    assert client.command(512, 280, target=(1, GIMBAL)) == 0
    assert client.wait("GIMBAL_MANAGER_INFORMATION").gimbal_device_id == GIMBAL
    assert client.command(1001, -2, -2, target=(1, GIMBAL)) == 0
    client.wait("GIMBAL_MANAGER_STATUS", such=lambda m: m.primary_control_sysid == 245)
    assert client.command(1000, -90, 0, NAN, NAN, 0, 0, 0, target=(1, 0)) == 0

    def down(message) -> bool:
        w, x, y, z = message.q
        return abs(2 * (w * y - z * x) + 1) < 0.01

    client.wait("GIMBAL_DEVICE_ATTITUDE_STATUS", 3.0, down)
    assert client.command(1000, 170, 0, target=(1, GIMBAL)) == mav.MAV_RESULT_DENIED
    client.mav.gimbal_manager_set_attitude_send(1, GIMBAL, 0, 0, [NAN] * 4, 0, 0, 0)
    client.mav.gimbal_manager_set_attitude_send(1, GIMBAL, 0, 0, [1, 0, 0, 0], NAN, NAN, NAN)
    client.forget()
    client.wait("GIMBAL_DEVICE_ATTITUDE_STATUS", 3.0, lambda m: abs(m.q[0] - 1) < 0.001)


def test_without_a_camera_there_is_one_heartbeat():
    with Bed("ardupilot") as bed:
        node = bed.endpoint.nodes[0]
        bare = Aboard(node.craft.autopilot, node.craft.personality, camera=False)
        bed.endpoint = Endpoint([bare], bed.endpoint.links)
        client = bed.client()
        client.wait("HEARTBEAT")
        bed.advance(3.0)
        assert {m.get_srcComponent() for m in client.heard} == {1}
        assert client.command(512, 280, target=(1, 0)) == mav.MAV_RESULT_UNSUPPORTED
