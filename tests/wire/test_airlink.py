"""Addresses of autopilots: the good ones pass, the others say what would be right."""

import pytest

from tests.devices.drone.flat import flat
from wire.airlink import address_fault
from wire.site import SiteError


@pytest.mark.parametrize(
    "url",
    [
        "udpin://127.0.0.1:14540",
        "udpout://drone.local:14550",
        "udpin://[::1]:14540",
        "tcpout://192.168.1.7:5760",
        "serial:///dev/ttyUSB0:57600",
        "serial://COM3:115200",
    ],
)
def test_good_addresses(url):
    assert address_fault(url) == ""


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("udpin://127.0.0.1", "lacks a host or a port; write udpin://HOST:PORT"),
        ("udp://:14540", "is no address of an autopilot; write udpin://127.0.0.1:14540"),
        ("tcpout://127.0.0.1:70000", "70000 is no port; give 1 to 65535"),
        ("serial:///dev/ttyUSB0", "lacks a device or a baud rate"),
        ("serial:///dev/ttyUSB0:0", "0 is no baud rate"),
        ("14540", "is no address of an autopilot"),
        ("", "is no address of an autopilot"),
    ],
)
def test_bad_addresses(url, words):
    assert words in address_fault(url)


@pytest.mark.parametrize(
    ("row", "words"),
    [
        ({"link": "udpin:14540"}, "test: robot.0.link: udpin:14540 is no address of an autopilot"),
        ({"link": None}, "robot.0.link: is missing: where drone-1's autopilot is, such as udpin://127.0.0.1:14540"),
        ({"kind": "quadruped"}, "robot.0.link: drone-1 is a quadruped, which has no autopilot"),
        ({"land_after_s": -1.0}, "robot.0.land_after_s"),
    ],
)
def test_a_site_file_says_what_is_wrong_with_a_drones_row(row, words):
    with pytest.raises(SiteError) as caught:
        flat(**row)
    assert words in str(caught.value)
