"""One vehicle's firmware: what comes in and what goes out. What it does about it stands in `sim.autopilot.conduct`."""

import math

from sim.autopilot import setpoints
from sim.autopilot.commands import COMMANDS
from sim.autopilot.conduct import Conduct
from sim.autopilot.flying import Climb
from sim.autopilot.geo import FARTHEST_M, Origin
from sim.autopilot.guided import Guided
from sim.autopilot.interface import (
    Ack,
    Answer,
    AttitudeSetpoint,
    Command,
    Item,
    Param,
    Plan,
    PositionTarget,
    Severity,
    Telemetry,
)
from sim.autopilot.manual import Manual, Sticks
from sim.autopilot.report import report
from sim.flight.state import AttitudeTarget, Trajectory, Vec3

_COMPLAINS_S = 1.0


class Firmware(Conduct):
    """An `Autopilot` above a `Vehicle`."""

    _complained_s = -math.inf
    # What comes in

    def command(self, command: Command, now_s: float) -> Answer:
        deed = COMMANDS.get(command.id)
        return Answer(Ack.UNSUPPORTED) if deed is None else deed(self, command, now_s)

    def position_target(self, target: PositionTarget, now_s: float) -> None:
        self._take(setpoints.trajectory(target, self.now), now_s)

    def attitude_target(self, target: AttitudeSetpoint, now_s: float) -> None:
        self._take(setpoints.attitude(target, self.now), now_s)

    def _take(self, found: Trajectory | AttitudeTarget | str, now_s: float) -> None:
        now, streams = self.now, self.now.row.setpoint_stream
        if not streams and not (now.mode == "offboard" and now.armed):
            return
        if isinstance(found, str):
            self._complain(f"Setpoint refused: {found}", now_s)
            return
        self.stream, self.failsafes.watch.setpoint_s = found, now_s
        if now.mode == "offboard" and isinstance(self.activity, Guided):
            if isinstance(self.activity.rest, Climb) and self.vehicle.on_ground:
                return
            self.activity.take(found, now_s)

    def _complain(self, text: str, now_s: float) -> None:
        if now_s - self._complained_s > _COMPLAINS_S:
            self._complained_s = now_s
            self.now.say(Severity.WARNING, text)

    def external_pose(self, position_ned_m: Vec3, heading_rad: float | None, now_s: float) -> None:
        if heading_rad is not None and not abs(heading_rad) < 1000.0:
            return
        near = all(abs(axis) <= FARTHEST_M for axis in position_ned_m)
        if near and self.vehicle.external_pose(now_s, position_ned_m, heading_rad):
            return
        self._complain("External pose rejected: it is far from the estimate", now_s)

    def set_origin(self, latitude_deg: float, longitude_deg: float, altitude_m: float) -> bool:
        origin = Origin(latitude_deg, longitude_deg, altitude_m)
        if not origin.valid() or self.now.gps == "fused":
            return False
        if self.now.armed and self.now.origin not in (None, origin):
            self.now.say(Severity.WARNING, "Origin refused: it is armed, and its places would move")
            return False
        self.now.origin = origin
        return True

    def manual(self, roll: float, pitch: float, throttle: float, yaw: float, now_s: float, sysid: int) -> bool:
        if not self._follows(sysid):
            if sysid not in self.strangers:
                self.strangers.add(sysid)
                followed = self.now.params.get("SYSID_MYGCS")
                self.now.say(Severity.WARNING, f"Sticks of system {sysid} ignored: SYSID_MYGCS is {followed:g}")
            return False
        fine = all(-1.0 <= stick <= 1.0 for stick in (roll, pitch, yaw)) and 0.0 <= throttle <= 1.0
        if fine and isinstance(self.activity, Manual):
            self.activity.sticks = Sticks(roll, pitch, throttle, yaw, now_s)
        return True

    def heard_station(self, now_s: float, sysid: int) -> None:
        if self._follows(sysid):
            self.failsafes.watch.station_s = now_s

    def _follows(self, sysid: int) -> bool:
        """ArduCopter has one ground station that counts, by its system id; PX4 counts them all."""
        return int(self.now.params.get("SYSID_MYGCS", sysid)) == sysid

    # Parameters and plans

    def params(self) -> list[Param]:
        return self.now.params.all()

    def set_param(self, name: str, value: float) -> Param | str:
        found = self.now.params.set(name, value)
        if isinstance(found, Param):
            if name == "SYSID_MYGCS":
                self.strangers.clear()
                self.failsafes.watch.station_s = None  # the other one is not waited for
            elif name == "SIM_BAT_DRAIN":
                self.vehicle.set_battery(None, value, None)
            elif name == "SIM_BAT_REMAIN" and value >= 0:
                self.vehicle.set_battery(value / 100, None, None)
            elif name == "SIM_BATT_VOLTAGE":
                self.vehicle.set_battery(None, None, value)
        return found

    def plan(self, kind: Plan) -> list[Item]:
        return self.plans.items(kind)

    def check_item(self, kind: Plan, item: Item) -> int:
        return self.plans.check(kind, item)

    def accept_plan(self, kind: Plan, items: list[Item]) -> int:
        return self.plans.accept(kind, items)

    def clear_plan(self, kind: Plan) -> int:
        return self.plans.accept(kind, [])

    def set_current(self, seq: int) -> bool:
        return self.plans.mission.go_to(seq)

    # What goes out

    def telemetry(self, now_s: float) -> Telemetry:
        return report(self, now_s)

    def texts(self) -> list[tuple[Severity, str]]:
        said, self.now.said = self.now.said, []
        return said

    def reached(self) -> list[int]:
        reached, self.plans.mission.reached = self.plans.mission.reached, []
        return reached

    def payload(self) -> list[Command]:
        wanted, self.now.payload = self.now.payload, []
        return wanted

    def progress(self) -> list[tuple[int, Ack, int]]:
        progress, self.news = self.news, []
        return progress

    def changed_params(self) -> list[Param]:
        return self.now.params.changed()
