"""A MAVProxy session: `python mavproxy_session.py MAVPROXY URL WATCH ardupilot|px4`. Prints OK at the end.

Commands go in as a person types them; what the vehicle did is read beside it with pymavlink at WATCH (udpin:HOST:PORT).
MAVProxy 1.8.75 cannot name PX4's modes: there the mode goes in as the command it stands for.
"""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

os.environ["MAVLINK20"] = "1"  # read by pymavlink when it is imported
from pymavlink import mavutil

MISSION = """QGC WPL 110
0\t1\t0\t16\t0\t0\t0\t0\t{lat:.7f}\t{lon:.7f}\t488\t1
1\t0\t3\t16\t0\t0.3\t0\t0\t{lat:.7f}\t{lon:.7f}\t2\t1
2\t0\t3\t16\t0\t0.3\t0\t0\t{north:.7f}\t{lon:.7f}\t2\t1
"""
MODES = {"GUIDED": (4, 6, 0), "AUTO": (3, 4, 4), "RTL": (6, 4, 5), "LAND": (9, 4, 6), "LOITER": (5, 4, 3)}
"""ArduCopter's number, PX4's main and sub mode."""


class Session:
    """MAVProxy as a process, and what it prints."""

    def __init__(self, mavproxy: str, url: str, watch: str, px4: bool) -> None:
        self.px4 = px4
        self.watch = mavutil.mavlink_connection(watch)
        self.folder = tempfile.TemporaryDirectory()
        self.said = Path(self.folder.name) / "said.txt"
        command = [sys.executable, mavproxy, f"--master={url}", "--state-basedir", self.folder.name]
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=self.said.open("wb"), stderr=subprocess.STDOUT, cwd=self.folder.name
        )

    def type(self, line: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(line.encode() + b"\n")
        self.process.stdin.flush()

    def prints(self, text: str, span_s: float = 20.0) -> None:
        end_s = time.monotonic() + span_s
        while text not in self.said.read_text(errors="replace"):
            if time.monotonic() > end_s or self.process.poll() is not None:
                raise RuntimeError(f"MAVProxy did not print {text!r}:\n{self.said.read_text(errors='replace')[-3000:]}")
            self.watch.recv_match(blocking=True, timeout=0.2)

    def sees(self, name: str, such: Callable[[Any], bool], span_s: float = 20.0) -> Any:
        end_s = time.monotonic() + span_s
        while time.monotonic() < end_s:
            message = self.watch.recv_match(type=name, blocking=True, timeout=0.5)
            if message is not None and message.get_srcComponent() == 1 and such(message):
                return message
        raise RuntimeError(f"no such {name}; MAVProxy:\n{self.said.read_text(errors='replace')[-3000:]}")

    def mode(self, name: str) -> None:
        number, main, sub = MODES[name]
        self.type(f"long DO_SET_MODE 1 {main} {sub}" if self.px4 else f"mode {name}")
        wanted = main << 16 | sub << 24 if self.px4 else number
        self.sees("HEARTBEAT", lambda m: m.custom_mode == wanted, 10.0)

    def close(self) -> None:
        self.type("exit")
        try:
            self.process.wait(10.0)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.folder.cleanup()


def fly(session: Session) -> None:
    session.prints("Detected vehicle")
    session.prints("Received")
    session.type("param show SIM_BAT_DRAIN")
    session.prints("SIM_BAT_DRAIN")
    session.type("param set SIM_BAT_DRAIN 3600")
    session.sees("PARAM_VALUE", lambda m: m.param_id == "SIM_BAT_DRAIN" and m.param_value == 3600)
    session.type("param set SIM_BAT_DRAIN 0")
    session.sees("SYS_STATUS", lambda m: bool(m.onboard_control_sensors_health & 0x10000000))
    if not session.px4:
        session.mode("GUIDED")
    session.type("arm throttle")
    session.sees("HEARTBEAT", lambda m: bool(m.base_mode & 128))
    if session.px4:
        session.type("long NAV_TAKEOFF 0 0 0 nan nan nan nan")
    else:
        session.type("takeoff 2")
    session.sees("LOCAL_POSITION_NED", lambda m: m.z < -1.2)
    here = session.sees("GLOBAL_POSITION_INT", lambda m: True)
    lat, lon = here.lat / 1e7, here.lon / 1e7
    plan = Path(session.folder.name) / "plan.txt"
    plan.write_text(MISSION.format(lat=lat, lon=lon, north=lat + 2e-5))
    session.type(f"wp load {plan}")
    session.prints("Loaded 3 waypoints")
    session.prints("TYPE_MISSION: ACCEPTED")
    session.type("wp list")
    session.prints("Saved 3 waypoints")
    session.mode("AUTO")
    session.sees("MISSION_ITEM_REACHED", lambda m: m.seq == 2, 40.0)
    session.mode("RTL")
    session.sees("HEARTBEAT", lambda m: not m.base_mode & 128, 60.0)
    print(session.said.read_text(errors="replace")[-1500:])
    print("OK")


if __name__ == "__main__":
    proxy = Session(*sys.argv[1:4], px4=sys.argv[4] == "px4")
    try:
        fly(proxy)
    finally:
        proxy.close()
