"""What `justw sitl` can be told, checked before anything is opened."""

import argparse
import ipaddress
import math
import sys
from dataclasses import dataclass
from typing import Literal, cast

from sim.scene import ORIGIN

MOST_VEHICLES = 10
ZURICH = (*ORIGIN, 0.0)
ARDUPILOT_TCP = 5760
GROUND_STATION = ("127.0.0.1", 14550)
OFFBOARD = ("127.0.0.1", 14540)


@dataclass(frozen=True, slots=True)
class Options:
    """`tcp` and `udp_in` are ports; 0 means any that is free."""

    firmware: Literal["ardupilot", "px4"]
    tcp: tuple[int, ...]
    udp_out: tuple[tuple[str, int], ...]
    udp_in: tuple[int, ...]
    vehicles: int
    gps: Literal["fused", "none"]
    home: tuple[float, float, float, float]
    """Latitude and longitude in degrees, altitude in metres AMSL, heading in degrees."""
    turned: bool
    """The heading was asked for: vehicles stand so even where the scene has headings of its own."""
    seed: int
    house: int | None
    """Seed of the home flown in; None for a bare floor."""
    camera: bool
    sign_key: bytes | None
    bind: str


def _port(text: str) -> int:
    if not text.isascii() or not text.isdigit() or int(text) > 65535:
        raise argparse.ArgumentTypeError(f"{text!r} is no port: give a number from 0 (any free one) to 65535")
    return int(text)


def _address(text: str) -> tuple[str, int]:
    host, colon, port = text.rpartition(":")
    if not colon or not host:
        raise argparse.ArgumentTypeError(f"{text!r}: give HOST:PORT, as 127.0.0.1:14550")
    number = _port(port)
    if number == 0:
        raise argparse.ArgumentTypeError(f"{text!r}: nobody can listen on port 0")
    return host, number


def vehicle_count(text: str) -> int:
    """How many one world can hold, from an argument."""
    if not text.isascii() or not text.isdigit() or not 1 <= int(text) <= MOST_VEHICLES:
        raise argparse.ArgumentTypeError(f"{text!r}: give 1 to {MOST_VEHICLES}")
    return int(text)


def _seed(text: str) -> int:
    if not text.isascii() or not text.isdigit():
        raise argparse.ArgumentTypeError(f"{text!r}: give a whole number, 0 or more")
    return int(text)


def _home(text: str) -> tuple[float, float, float, float]:
    try:
        numbers = tuple(float(part) for part in text.split(","))
    except ValueError:
        numbers = ()
    if len(numbers) != 4 or not all(map(math.isfinite, numbers)):
        raise argparse.ArgumentTypeError(f"{text!r}: give LAT,LON,ALT,YAW, as 47.397742,8.545594,488,0")
    latitude, longitude, altitude_m, yaw = numbers
    if abs(latitude) >= 89.9 or abs(longitude) > 180 or abs(altitude_m) >= 10_000 or abs(yaw) > 360:
        wide = "degrees within +-89.9, +-180 and +-360, metres within +-10000"
        raise argparse.ArgumentTypeError(f"{text!r}: {wide}")
    return latitude, longitude, altitude_m, yaw


def _scene(text: str) -> int | None:
    kind, colon, seed = text.partition(":")
    if text == "empty":
        return None
    if kind != "home" or not colon:
        raise argparse.ArgumentTypeError(f"{text!r}: give empty, or home:SEED as home:7")
    return _seed(seed)


def _key(text: str) -> bytes:
    try:
        key = bytes.fromhex(text)
    except ValueError:
        key = b""
    if len(key) != 32:
        raise argparse.ArgumentTypeError("the key is 32 bytes, given as 64 hexadecimal digits")
    return key


def _bind(text: str) -> str:
    try:
        return str(ipaddress.IPv4Address(text))
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text!r}: give an IPv4 address of this machine, as 192.168.1.20") from error


def _joined(argv: list[str]) -> list[str]:
    """A home in the south begins with a minus, which would be read as an option's name."""
    joined: list[str] = []
    for word in argv:
        if joined and joined[-1] == "--home" and word.startswith("-") and not word.startswith("--"):
            joined[-1] = f"--home={word}"
        else:
            joined.append(word)
    return joined


def parse(argv: list[str] | None) -> Options:
    """Ends the program with status 2 and one sentence when something is wrong."""
    parser = argparse.ArgumentParser(
        prog="python -m sim.sitl", description="Simulated drones that any MAVLink ground station or library can fly."
    )
    add = parser.add_argument
    add("--firmware", choices=("ardupilot", "px4"), default="ardupilot", help="whose habits it has (ardupilot)")
    links = "with no link named: TCP 5760 and UDP to 14550 (ardupilot), UDP to 14540 and 14550 (px4)"
    add("--tcp", type=_port, action="append", default=[], metavar="PORT", help=f"serve TCP clients; {links}")
    add("--udp-out", type=_address, action="append", default=[], metavar="HOST:PORT", help="send there unasked")
    add("--udp-in", type=_port, action="append", default=[], metavar="PORT", help="answer whoever sends here")
    add("--vehicles", type=vehicle_count, default=1, metavar="N", help="how many, with system ids from 1")
    add("--gps", choices=("fused", "none"), default="fused", help="indoor position as a GPS fix, or none at all")
    add(
        "--home",
        type=_home,
        default=None,
        metavar="LAT,LON,ALT,YAW",
        help="where the origin lies (Zurich), and the way they face",
    )
    add("--seed", type=_seed, default=0, metavar="N", help="of the sensors' noise")
    add("--scene", type=_scene, default=None, metavar="home:SEED|empty", help="a furnished home, or a bare floor")
    shown = "show a camera and a gimbal (on for px4; off for ardupilot, as dronekit is confused by them)"
    add("--camera", choices=("on", "off"), default=None, help=shown)
    add("--sign-key", type=_key, default=None, metavar="HEX", help="take only commands signed with this key")
    add(
        "--bind",
        type=_bind,
        default="127.0.0.1",
        metavar="ADDRESS",
        help="this machine's address there lets other machines in (127.0.0.1)",
    )
    given = parser.parse_args(_joined(sys.argv[1:] if argv is None else argv))
    tcp, udp_out = tuple(given.tcp), tuple(given.udp_out)
    if not (tcp or udp_out or given.udp_in):
        ardupilot = given.firmware == "ardupilot"
        tcp = (ARDUPILOT_TCP,) if ardupilot else ()
        udp_out = (GROUND_STATION,) if ardupilot else (OFFBOARD, GROUND_STATION)
    return Options(
        firmware=given.firmware,
        tcp=tcp,
        udp_out=udp_out,
        udp_in=tuple(given.udp_in),
        vehicles=given.vehicles,
        gps=given.gps,
        home=given.home or ZURICH,
        turned=given.home is not None,
        seed=given.seed,
        house=cast("int | None", given.scene),
        camera=given.firmware == "px4" if given.camera is None else given.camera == "on",
        sign_key=given.sign_key,
        bind=given.bind,
    )
