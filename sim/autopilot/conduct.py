"""What a vehicle's firmware is doing: its mode, whether it is armed, and the activity of this moment."""

import math
from typing import Literal

from sim.autopilot import arming
from sim.autopilot.alarms import Action
from sim.autopilot.failsafes import Failsafes
from sim.autopilot.fence import breach
from sim.autopilot.flying import Activity, Climb, Descend, GoHome, Hover
from sim.autopilot.geo import Origin
from sim.autopilot.guided import Guided
from sim.autopilot.interface import Ack, Answer, Severity
from sim.autopilot.manual import Manual
from sim.autopilot.mission_run import MissionRun
from sim.autopilot.params import Params
from sim.autopilot.personality import Mode, Personality
from sim.autopilot.phase import taking_off
from sim.autopilot.plans import Plans
from sim.autopilot.situation import LOWEST_FLIGHT_M, Situation
from sim.flight.state import AttitudeTarget, Trajectory, Vehicle

_DECIDE_S = 1 / 60 - 1e-4
_LOOK_S = 1 / 20 - 1e-4
_STREAM_S = 0.5
"""PX4's offboard mode is entered when the last setpoint is not older."""
_TELL_S = 0.4
_CRASH_S = 2.0
_NEEDS_POSITION = frozenset({"hold", "takeoff", "return", "mission", "offboard", "position"})
_AUTO = frozenset({"takeoff", "land", "return", "mission"})


class Conduct:
    """The part of the firmware that acts."""

    def __init__(
        self,
        vehicle: Vehicle,
        personality: Personality,
        sysid: int = 1,
        origin: tuple[float, float, float] | None = None,
        gps: Literal["fused", "none"] = "fused",
        ceiling_m: float = math.inf,
        nose_to_region: bool = False,
    ) -> None:
        """`origin`: (latitude deg, longitude deg, altitude m AMSL) of local NED's origin, unused without `fused`
        positioning. `ceiling_m`: above the floor. `nose_to_region`: no gimbal turns to a region of interest for it."""
        self.sysid = sysid
        self.vehicle = vehicle
        at = Origin(*origin) if origin is not None and gps == "fused" else None
        first: Mode = "stabilize" if personality.name == "ardupilot" else "hold"
        self.now = Situation(
            vehicle, personality, Params(personality.params, sysid), gps, ceiling_m, at, first, personality.modes[first],
            nose_to_region=nose_to_region,
        )  # fmt: skip
        self.plans = Plans(self.now)
        self.failsafes = Failsafes()
        self.waiting: tuple[int, float, float] | None = None
        """(command, from, until) of a command in progress."""
        self.news: list[tuple[int, Ack, int]] = []
        """(command, result, percent) not told yet."""
        self.stream: Trajectory | AttitudeTarget | None = None
        """The latest setpoint, where offboard flies a stream of them."""
        self.strangers: set[int] = set()
        """System ids of stations that do not count, whose sticks were ignored and who were told so."""
        self.activity: Activity = self.begin(first)
        self._decided_s = self._looked_s = self._told_s = -math.inf
        self._grounded_s: float | None = None
        self._tipped_s: float | None = None
        self._flown = False

    # At every step

    def step(self, now_s: float) -> None:
        if now_s - self._looked_s >= _LOOK_S:
            self._looked_s = now_s
            self._look(now_s)
        if now_s - self._decided_s >= _DECIDE_S:
            self._decided_s = now_s
            if self.now.armed:
                self._follow(now_s)
            if self.now.armed:
                self.vehicle.command(self.activity.step(self.now, now_s))

    def _look(self, now_s: float) -> None:
        now, watch = self.now, self.failsafes.watch
        if now.home_ned_m is None and now.located:
            self.home_here()
        watch.fence(breach(now, self.plans.fence) if now.located else "", now_s)
        action = self.failsafes.look(now, now_s)
        if action is Action.TERMINATE:
            self.disarm("Flight terminated", now_s)
        elif action is Action.LAND or (action is Action.RETURN and not now.located):
            self.enter("land", now_s)
        elif action is Action.RETURN:
            self.enter("return", now_s)
        elif action is Action.HOLD:
            self.enter("hold", now_s)
        if self.waiting is not None:
            command, begun_s, until_s = self.waiting
            if now_s >= until_s:
                self.news.append((command, Ack.ACCEPTED, 100))
                self.waiting = None
            elif now_s - self._told_s >= _TELL_S:
                self._told_s = now_s
                share = (now_s - begun_s) / max(1e-6, until_s - begun_s)
                self.news.append((command, Ack.IN_PROGRESS, int(100 * share)))

    def _follow(self, now_s: float) -> None:
        """What comes by itself: hold after take-off, disarming after landing, after idling and after a crash."""
        now, ardupilot = self.now, self.now.row.name == "ardupilot"
        if now.mode == "takeoff" and self.activity.done and isinstance(self.activity, Climb):
            rest = self.activity
            self.enter("hold", now_s)
            self.activity = Hover(rest.place_ned_m, rest.heading_rad)
        if now.mode == "mission" and self.activity.done and not ardupilot and now.flying:
            self.enter("hold", now_s)
        tipped = self.vehicle.tipped and math.hypot(*now.estimate.velocity_ned_mps) < 0.5
        self._tipped_s = (self._tipped_s or now_s) if tipped else None
        if self._tipped_s is not None and now_s - self._tipped_s > _CRASH_S:
            self.disarm("Crash: disarming", now_s)
            return
        self._flown = self._flown or now.flying
        idle = self.vehicle.on_ground and not taking_off(self.activity) and not self._asked_up(now_s)
        self._grounded_s = (self._grounded_s if self._grounded_s is not None else now_s) if idle else None
        if self._grounded_s is None:
            return
        landed = (self.activity.done and now.mode in ("land", "return", "mission")) or (self._flown and not ardupilot)
        if landed:
            span_s = 1e-3 if ardupilot else now.params.get("COM_DISARM_LAND")
        else:
            span_s = now.params.get("DISARM_DELAY" if ardupilot else "COM_DISARM_PRFLT")
        if span_s > 0.0 and now_s - self._grounded_s >= span_s:  # 0 and less: never
            self.disarm("Disarmed after landing" if landed else "Disarmed: idle on the ground", now_s)

    def _asked_up(self, now_s: float) -> bool:
        """Whether what goes on will leave the ground, or waits there on purpose."""
        activity = self.activity
        if isinstance(activity, Manual):
            return not activity.idle(now_s)
        if isinstance(activity, MissionRun):
            return not activity.done
        return isinstance(activity, Guided) and self.now.row.setpoint_stream and not self._flown

    # Modes

    def begin(self, mode: Mode) -> Activity:
        """The activity of a mode, from its beginning."""
        now = self.now
        if mode == "hold":
            return Hover()
        if mode == "takeoff":
            height = max(now.params.get("MIS_TAKEOFF_ALT", 1.0), LOWEST_FLIGHT_M)
            return Climb(now.below_ceiling((0.0, 0.0, now.above_start(height)))[2])
        if mode == "land":
            return Descend()
        if mode == "return":
            return GoHome()
        if mode == "mission":
            if now.armed and self.plans.mission.finished:
                self.plans.mission.restart()
            return MissionRun(self.plans.mission)
        if mode == "offboard":
            guided = Guided()
            if now.row.setpoint_stream and self.stream is not None:
                guided.take(self.stream, self.failsafes.watch.setpoint_s)
            return guided
        return Manual(leaning=mode == "stabilize")

    def refusal(self, mode: Mode, now_s: float) -> str:
        """Why a mode can not be entered now; empty when it can."""
        now = self.now
        if now.armed and mode in _NEEDS_POSITION and not now.located:
            return "it needs a position estimate"
        if mode == "mission" and self.plans.mission.empty:
            return "there is no mission"
        if mode == "takeoff" and now.flying:
            return "it is flying already"
        if mode == "offboard" and now.row.setpoint_stream and now_s - self.failsafes.watch.setpoint_s > _STREAM_S:
            return "there is no stream of setpoints"
        return ""

    def enter(self, mode: Mode, now_s: float, custom_mode: int | None = None) -> None:
        """Change the mode; the caller has seen to it that it may be."""
        now = self.now
        if mode != now.mode:
            now.speed_mps = None
        now.mode = mode
        now.custom_mode = now.row.modes[mode] if custom_mode is None else custom_mode
        if self.waiting is not None:
            self.news.append((self.waiting[0], Ack.CANCELLED, 0))
            self.waiting = None
        self.activity = self.begin(mode)

    def choose(self, mode: Mode, now_s: float, custom_mode: int | None = None) -> Answer:
        """Change the mode because somebody asked for it."""
        if why := self.refusal(mode, now_s):
            return Answer(self.now.row.refused, f"Mode change to {mode} refused: {why}")
        number = self.now.row.modes[mode] if custom_mode is None else custom_mode
        if number != self.now.custom_mode or mode == "hold" or (mode in _AUTO and self.activity.done):
            self.failsafes.taken_over()
            self.enter(mode, now_s, number)
        return Answer(Ack.ACCEPTED)

    def set_mode(self, base_mode: int, custom_mode: int, now_s: float) -> Answer:
        mode = self.now.row.mode(custom_mode)
        if not base_mode & 1 or mode is None:
            what = (
                f"There is no mode {self.now.row.numbers(custom_mode)}"
                if mode is None
                else "Only custom modes are known"
            )
            return Answer(self.now.row.unknown_mode, what)
        return self.choose(mode, now_s, custom_mode)

    # Arming

    def arm(self, now_s: float, force: bool) -> Answer:
        now = self.now
        if now.armed:
            return Answer(Ack.ACCEPTED)
        if not force:
            stale = self.refusal(now.mode, now_s)
            why = arming.mode_reason(now) or (f"Mode {now.mode}: {stale}" if stale else "")
            prefix = "Arm: " if now.row.name == "ardupilot" else "Arming denied: "
            reasons = [prefix + text for text in (*arming.reasons(now, self.failsafes.watch), why) if text]
            for text in reasons[1:]:
                now.say(Severity.WARNING, text)
            if reasons:
                return Answer(now.row.refused, reasons[0])
        now.armed, now.armed_since_s = True, now_s
        self._grounded_s = self._tipped_s = None
        self._flown = False
        if now.located and not now.home_kept:
            self.home_here()
        self.vehicle.arm()
        if now.mode != "takeoff":
            self.activity = self.begin(now.mode)
        self.failsafes.armed(now, now_s)
        now.say(Severity.INFO, "Arming motors" if now.row.name == "ardupilot" else "Armed")
        return Answer(Ack.ACCEPTED)

    def disarm(self, text: str, now_s: float) -> None:
        """At once, wherever it is."""
        now = self.now
        now.armed, now.speed_mps, now.region_ned_m = False, None, None
        self.vehicle.disarm()
        self.failsafes.taken_over()
        now.say(Severity.INFO, text)
        back = now.row.setpoint_stream and now.mode in ("land", "return", "takeoff", "mission", "offboard")
        self.enter("hold" if back else now.mode, now_s, None if back else now.custom_mode)

    def home_here(self) -> None:
        self.now.home_ned_m, self.now.home_heading_rad = self.now.here, self.now.estimate.heading_rad

    def reboot(self, now_s: float) -> None:
        """As after switching on; the caller has seen to it that it is disarmed."""
        self.failsafes = Failsafes()
        self.stream = None
        self.plans.mission.restart()
        now = self.now
        first: Mode = "stabilize" if now.row.name == "ardupilot" else "hold"
        self.enter(first, now_s)
        now.home_ned_m, now.home_kept, now.speed_mps, now.region_ned_m = None, False, None, None
        now.origin = now.origin if now.gps == "fused" else None
        now.say(Severity.INFO, now.row.banner)
