"""A MAVProxy session, typed as a pilot would: modes, arming, take-off, parameters, a mission, return, landing."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.walk.ground_station import CLIENTS, Autopilot, Session, needs_clients, wait_for

pytestmark = [pytest.mark.walk, needs_clients]
HOME = (47.397742, 8.545594)
NORTH_DEG = 1.35e-5
"""1.5 m."""
COURSE = [
    (3, 22, 0, 0, 0, 0, *HOME, 1.2, 1),
    (3, 16, 0, 0, 0, 0, HOME[0] + NORTH_DEG, HOME[1], 1.2, 1),
    (3, 21, 0, 0, 0, 0, HOME[0] + NORTH_DEG, HOME[1], 0, 1),
]
"""Take off, a waypoint, land: frame, command, four parameters, latitude, longitude, height, go on by itself."""
COURSES = {"ardupilot": [(0, 16, 0, 0, 0, 0, *HOME, 0, 1), *COURSE], "px4": COURSE}
"""ArduCopter keeps home as the first item."""


@pytest.fixture
def firmware(request) -> str:
    return request.param


@pytest.fixture
def session(tmp_path: Path, firmware: str) -> Iterator[Session]:
    home = ",".join(map(str, HOME)) + ",0,0"
    items = ["\t".join(map(str, (k, 0, *item))) for k, item in enumerate(COURSES[firmware])]
    (tmp_path / "course.txt").write_text("\n".join(["QGC WPL 110", *items, ""]))
    with Autopilot(tmp_path, firmware, "--home", home) as autopilot:
        master = f"tcp:127.0.0.1:{autopilot.tcp_port}"
        command = (str(CLIENTS / "mavproxy.py"), "--master", master, "--state-basedir", str(tmp_path))
        with Session(tmp_path, str(CLIENTS / "python"), *command) as session:
            session.hear(r"Received \d+ parameters", 20.0)
            yield session


def parameter(session: Session, name: str) -> float:
    return float(session.do(f"param show {name}", rf"{name} +(-?[\d.]+)")[1])


def set_parameter(session: Session, name: str, value: float) -> None:
    """MAVProxy shows what the vehicle last told, which comes some time after the setting."""
    session.say(f"param set {name} {value:g}")
    wait_for(lambda: parameter(session, name) == pytest.approx(value), 10.0, session.log)


def standing_north_m(session: Session) -> float:
    return float(session.do("status LOCAL_POSITION_NED", r"LOCAL_POSITION_NED {.* x : (-?[\d.e-]+)")[1])


def load_and_list(session: Session) -> None:
    session.do("wp load course.txt", r"MISSION_ACK: TYPE_MISSION: ACCEPTED")
    session.do("wp list", r"Requesting \d+ waypoints")
    session.hear(r"^22 3 .* 1\.2000")
    session.hear(rf"^16 3 {HOME[0] + NORTH_DEG:.10f}")
    session.hear(r"^21 3 ")
    session.hear(r"Saved \d+ waypoints")


@pytest.mark.parametrize("firmware", ["ardupilot"], indirect=True)
def test_an_arducopter(session: Session) -> None:
    session.do("mode GUIDED", r"Mode GUIDED")
    session.do("arm throttle", r"^ARMED")
    session.do("takeoff 1.2", r"NAV_TAKEOFF: ACCEPTED")
    set_parameter(session, "RTL_ALT", 120.0)
    session.do("param show BATT_FS*", r"BATT_FS_LOW_ACT +2")
    load_and_list(session)
    session.do("mode AUTO", r"waypoint 2")
    session.hear(r"waypoint 3")
    session.hear(r"^DISARMED", 25.0)
    assert "Mode AUTO" in session.log()
    assert standing_north_m(session) == pytest.approx(1.5, abs=0.3)
    session.do("mode GUIDED", r"Mode GUIDED")
    session.do("arm throttle", r"^ARMED")
    session.do("takeoff 1", r"NAV_TAKEOFF: ACCEPTED")
    session.do("mode LAND", r"Mode LAND")
    session.hear(r"^DISARMED", 25.0)


@pytest.mark.parametrize("firmware", ["px4"], indirect=True)
def test_a_px4(session: Session) -> None:
    """By the numbers of its modes: MAVProxy 1.8.75 sets none of PX4's by name."""
    session.do("arm throttle", r"^ARMED")
    session.do("takeoff 1.2", r"NAV_TAKEOFF: ACCEPTED")
    set_parameter(session, "MPC_LAND_SPEED", 0.6)
    load_and_list(session)
    session.do("long DO_SET_MODE 1 4 4", r"Mode MISSION")
    session.hear(r"^DISARMED", 30.0)
    assert standing_north_m(session) == pytest.approx(1.5, abs=0.3)
    session.do("arm throttle", r"^ARMED")
    session.do("long DO_SET_MODE 1 4 2", r"Mode TAKEOFF")
    session.do("long DO_SET_MODE 1 4 5", r"Mode RTL")
    session.hear(r"^DISARMED", 30.0)
    assert abs(standing_north_m(session) - 1.5) < 0.3, "home is where it was armed"
