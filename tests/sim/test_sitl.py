"""The drone simulator's options and its first lines; that it ends when told."""

import signal
import socket
import subprocess
import sys
from math import radians, remainder, tau

import pytest

from sim.sitl import main
from sim.sitl_flight import Flight, Sitl
from sim.sitl_options import parse


def test_links_by_default() -> None:
    ardupilot, px4 = parse([]), parse(["--firmware", "px4"])
    assert (ardupilot.tcp, ardupilot.udp_out, ardupilot.bind) == ((5760,), (("127.0.0.1", 14550),), "127.0.0.1")
    assert (px4.tcp, px4.udp_out) == ((), (("127.0.0.1", 14540), ("127.0.0.1", 14550)))
    assert parse(["--udp-in", "0"]).tcp == ()


@pytest.mark.parametrize(
    "arguments", [["--home", "-35.363262,149.165237,584,353"], ["--home=-35.363262,149.165237,584,353"]]
)
def test_a_home_in_the_south(arguments) -> None:
    """Where ArduPilot's own simulation stands."""
    assert parse(arguments).home == (-35.363262, 149.165237, 584.0, 353.0)
    assert parse(["--seed", "2", *arguments, "--tcp", "0"]).tcp == (0,)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--tcp", "70000"], "is no port"),
        (["--udp-out", "14550"], "give HOST:PORT"),
        (["--home", "1,2,3"], "give LAT,LON,ALT,YAW"),
        (["--home", "91,2,3,0"], "degrees within"),
        (["--home", "-95,2,3,0"], "degrees within"),
        (["--home", "1,2,3,1e300"], "degrees within"),
        (["--home", "--seed"], "expected one argument"),
        (["--home", "nan,2,3,0"], "give LAT,LON,ALT,YAW"),
        (["--vehicles", "0"], "give 1 to 10"),
        (["--scene", "house"], "give empty, or home:SEED"),
        (["--sign-key", "abc"], "64 hexadecimal digits"),
        (["--bind", "everywhere"], "give an IPv4 address"),
        (["--firmware", "inav"], "invalid choice"),
    ],
)
def test_bad_arguments_get_a_sentence(arguments, sentence, capsys) -> None:
    with pytest.raises(SystemExit) as ended:
        parse(arguments)
    assert ended.value.code == 2
    assert sentence in capsys.readouterr().err


@pytest.mark.parametrize(("arguments", "status"), [(["--help"], 0), (["--vehicles", "0"], 2)])
def test_help_comes_without_a_simulator(arguments, status) -> None:
    """PyBullet says when it was built as soon as it is imported."""
    done = subprocess.run([sys.executable, "-m", "sim.sitl", *arguments], capture_output=True, text=True, timeout=60)
    assert done.returncode == status
    assert "--firmware" in done.stdout + done.stderr
    assert "build time" not in done.stdout + done.stderr


def test_port_in_use(capsys) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert main(["--udp-in", "0", "--tcp", str(port)]) == 1
    assert f"TCP port {port} is in use" in capsys.readouterr().err


def test_a_station_elsewhere_needs_an_address_to_bind_to(capsys) -> None:
    assert main(["--udp-out", "192.0.2.7:14550"]) == 1
    assert "leaves this machine, but links bind to 127.0.0.1: add --bind ADDRESS" in capsys.readouterr().err


def test_in_a_home() -> None:
    sitl = Sitl(parse(["--scene", "home:7", "--tcp", "0", "--vehicles", "2", "--gps", "none", "--sign-key", "ab" * 32]))
    text = "\n".join(sitl.lines())
    assert "system ids 1 to 2, over home 7" in text
    assert "no GPS" in text
    assert "47.39" not in text, "nobody has told it an origin"
    assert "signed with the key" in text
    for _ in range(240):
        sitl.flight.step()
    assert all(firmware.vehicle.on_ground for firmware in sitl.flight.firmwares)
    sitl.close()


def test_in_a_home_it_faces_as_asked() -> None:
    scene, links = ["--scene", "home:7"], ["--tcp", "0"]
    own, turned = (Flight(parse([*scene, *links, *home])) for home in ([], ["--home", "47.397742,8.545594,488,135"]))
    headings = [radians(90) - flight.vehicles[0].true_pose()[1] for flight in (own, turned)]
    assert remainder(headings[1] - radians(135), tau) == pytest.approx(0.0, abs=1e-3)
    assert own.vehicles[0].true_pose()[0] == pytest.approx(turned.vehicles[0].true_pose()[0], abs=1e-3)
    assert abs(remainder(headings[0] - headings[1], tau)) > 0.1
    for flight in (own, turned):
        flight.close()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ends_when_told(number) -> None:
    command = [sys.executable, "-m", "sim.sitl", "--tcp", "0", "--udp-in", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        while not process.stdout.readline().startswith("ready"):
            assert process.poll() is None
        process.send_signal(number)
        _, errors = process.communicate(timeout=20)
    assert process.returncode == 0
    assert "Traceback" not in errors
