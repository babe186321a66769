"""Commands that move the vehicle: take off, land, return, go to, orbit, wait, turn, pause, start a mission."""

import math
from dataclasses import replace

from sim.autopilot.conduct import Conduct
from sim.autopilot.fence import beyond
from sim.autopilot.flying import Circle, Climb, Hover, braked
from sim.autopilot.geo import GLOBAL_FRAMES, HOME_FRAMES, place
from sim.autopilot.guided import Guided
from sim.autopilot.interface import Ack, Answer, Command, Severity
from sim.autopilot.mission_run import MissionRun
from sim.autopilot.situation import LOWEST_FLIGHT_M, Situation
from sim.flight.state import Trajectory, Vec3

ACCEPTED = Answer(Ack.ACCEPTED)
_FASTEST_MPS = 20.0


def named_place(now: Situation, command: Command, what: str) -> Vec3 | Answer:
    """Local NED of the place that a command names, or why `what` is refused."""
    frame = _frame(command)
    if frame in GLOBAL_FRAMES and command.id in now.row.above_sea_level:
        frame = 0
    found = place(frame, command.x, command.y, command.z, now.origin, now.home, now.here)
    if found is None:
        return Answer(Ack.UNSUPPORTED_FRAME)
    return Answer(Ack.DENIED, f"{what} refused: {found}") if isinstance(found, str) else found


def _frame(command: Command) -> int:
    """A COMMAND_LONG has none: its places are global, above mean sea level."""
    return 0 if command.frame is None else command.frame


def take_off(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """NAV_TAKEOFF."""
    now = conduct.now
    if now.flying:
        return Answer(now.row.refused, "Takeoff refused: it is flying already")
    if now.armed and not now.located:
        return Answer(now.row.refused, "Takeoff refused: it needs a position estimate")
    if math.isinf(command.z):
        return Answer(Ack.DENIED, "Takeoff refused: the height is not finite")
    if now.row.takeoff == "guided":
        return _take_off_guided(conduct, command)
    down, lifted = now.above_start(now.params.get("MIS_TAKEOFF_ALT")), False
    if not math.isnan(command.z):
        found = named_place(now, replace(command, x=math.nan, y=math.nan), "Takeoff")
        if isinstance(found, Answer):
            return found
        lifted = found[2] > down
        down = min(down, found[2])
    answer = conduct.choose("takeoff", now_s)
    if answer.result is Ack.ACCEPTED:
        if lifted:
            now.say(Severity.NOTICE, "Using minimum takeoff altitude")
        conduct.activity = Climb(now.lowered((0.0, 0.0, down), "Takeoff")[2])
    return answer


def _take_off_guided(conduct: Conduct, command: Command) -> Answer:
    now = conduct.now
    if command.frame is not None and command.frame not in HOME_FRAMES:
        return Answer(Ack.DENIED, "Takeoff refused: its altitude must be relative to home (frame 3)")
    if not 0.0 < command.z < 1000.0:
        return Answer(now.row.refused, "Takeoff refused: it needs a height above home")
    if not now.armed or not isinstance(conduct.activity, Guided):
        missing = "armed" if not now.armed else "in guided mode"
        return Answer(now.row.refused, f"Takeoff refused: it is not {missing}")
    down = now.home[2] - max(command.z, LOWEST_FLIGHT_M)
    if down > now.here[2]:
        return Answer(now.row.refused, f"Takeoff refused: {command.z:g} m above home is below where it stands")
    conduct.activity.target = None
    conduct.activity.rest = Climb(now.lowered((0.0, 0.0, down), "Takeoff")[2])
    return ACCEPTED


def land(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """NAV_LAND, where it is."""
    if not conduct.now.armed:
        return Answer(conduct.now.row.refused, "Landing refused: it is not armed")
    return conduct.choose("land", now_s)


def come_home(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """NAV_RETURN_TO_LAUNCH."""
    if not conduct.now.armed:
        return Answer(conduct.now.row.refused, "Return refused: it is not armed")
    return conduct.choose("return", now_s)


def go(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """DO_REPOSITION: params 1 ground speed, 2 bit 0 whether the mode may change, 4 yaw in radians."""
    now, speed, yaw = conduct.now, command.params[0], command.params[3]
    guided = now.row.takeoff == "guided"
    if not math.isnan(speed) and not speed <= _FASTEST_MPS:
        return Answer(Ack.DENIED, f"Go to refused: a speed of {speed:g} m/s")
    if math.isinf(yaw) or abs(yaw) > 1000.0:
        return Answer(Ack.DENIED, "Go to refused: the yaw makes no sense")
    mode = "offboard" if guided else "hold"
    may_change = math.isfinite(command.params[1]) and int(command.params[1]) & 1
    if now.mode != mode and not may_change:
        return Answer(Ack.DENIED, f"Go to refused: it is in mode {now.mode}")
    target = _destination(conduct, command, "Go to")
    if isinstance(target, Answer):
        return target
    heading = None if math.isnan(yaw) or (guided and yaw == 0.0) else math.remainder(yaw, math.tau)
    rest = Hover(now.below_ceiling(target), heading, speed if speed > 0.0 else None)
    return _do(conduct, rest, now_s, target, "Go to")


def orbit(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """DO_ORBIT: params 1 radius (negative: to the left), 2 speed, 4 radians to turn (0 or NaN: for ever)."""
    radius, speed, _, angle = command.params
    radius = 2.0 if math.isnan(radius) else radius
    speed = 1.0 if math.isnan(speed) else speed
    if not 0.3 <= abs(radius) <= 100.0:
        return Answer(Ack.DENIED, f"Orbit refused: a radius of {radius:g} m")
    if not 0.0 < speed * speed <= 3.0 * abs(radius) or speed > _FASTEST_MPS or speed < 0.0:
        return Answer(Ack.DENIED, f"Orbit refused: {speed:g} m/s on a radius of {abs(radius):g} m")
    target = _target(conduct, command, "Orbit")
    if isinstance(target, Answer):
        return target
    turns = abs(angle) / math.tau if math.isfinite(angle) and angle else math.inf
    circle = Circle(conduct.now.below_ceiling(target), radius, speed, turns)
    return _do(conduct, circle, now_s, target, "Orbit")


def wait(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """NAV_DELAY: hover for param 1 seconds; in progress until then."""
    now, span_s = conduct.now, command.params[0]
    if not now.flying or not now.located:
        return Answer(now.row.refused, "Delay refused: it is not flying")
    if not 0.0 <= span_s <= 86400.0:
        return Answer(Ack.DENIED, f"Delay refused: {span_s:g} s")
    answer = _do(conduct, Hover(braked(now)), now_s, now.here, "Delay")
    if answer.result is Ack.ACCEPTED:
        conduct.waiting = (command.id, now_s, now_s + span_s)
        return Answer(Ack.IN_PROGRESS)
    return answer


def turn(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """CONDITION_YAW: params 1 degrees, 3 the hand and 4 whether relative."""
    now, (angle, _, hand, relative) = conduct.now, command.params
    if not now.flying:
        return Answer(now.row.refused, "Turn refused: it is not flying")
    if not abs(angle) <= 360.0:
        return Answer(Ack.DENIED, f"Turn refused: {angle:g} degrees")
    heading = math.radians(angle)
    if relative == 1.0:
        heading = now.estimate.heading_rad + math.copysign(1.0, hand if hand == -1.0 else 1.0) * heading
    heading = math.remainder(heading, math.tau)
    activity = conduct.activity
    if isinstance(activity, Hover):
        activity.heading_rad = heading
    elif isinstance(activity, Guided) and isinstance(activity.target, Trajectory):
        activity.target = replace(activity.target, heading_rad=heading, heading_rate_radps=None)
    elif isinstance(activity, Guided):
        place_ned_m = activity.place_ned_m or braked(now)
        activity.target, activity.rest = None, Hover(place_ned_m, heading)
    else:
        return Answer(now.row.refused, f"Turn refused: it is in mode {now.mode}")
    now.region_ned_m = None
    return ACCEPTED


def pause(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """DO_PAUSE_CONTINUE: param 1 is 0 to pause, 1 to go on."""
    now, activity = conduct.now, conduct.activity
    if command.params[0] not in (0.0, 1.0):
        return Answer(Ack.DENIED)
    on = command.params[0] == 1.0
    if not now.armed:
        return Answer(now.row.refused, "Pause refused: it is not armed")
    if now.row.takeoff == "auto":
        return conduct.choose("mission" if on else "hold", now_s)
    if isinstance(activity, MissionRun):
        activity.paused = not on
    elif isinstance(activity, Guided) and not on and now.flying:
        activity.target, activity.rest = None, Hover()
    elif not isinstance(activity, Guided):
        return Answer(now.row.refused, f"Pause refused: it is in mode {now.mode}")
    return ACCEPTED


def override(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """OVERRIDE_GOTO: params 1 hold or go on, 2 here or at a place, 3 its frame, 4 yaw in degrees."""
    now = conduct.now
    if not now.flying:
        return Answer(now.row.refused, "Override refused: it is not flying")
    if command.params[0] == 1.0:
        return conduct.choose("mission", now_s)
    if command.params[0] != 0.0 or command.params[1] not in (2.0, 3.0):
        return Answer(Ack.DENIED)
    if command.params[1] == 2.0:
        return conduct.choose("hold", now_s)
    frame = command.params[2]
    if not (math.isfinite(frame) and frame == int(frame)):
        return Answer(Ack.UNSUPPORTED_FRAME)
    target = _destination(conduct, replace(command, frame=int(frame)), "Override")
    if isinstance(target, Answer):
        return target
    answer = conduct.choose("hold", now_s)
    if answer.result is Ack.ACCEPTED:
        yaw = command.params[3]
        conduct.activity = Hover(now.below_ceiling(target), math.radians(yaw) if abs(yaw) <= 360.0 else None)
    return answer


def start_mission(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """MISSION_START: param 1 is the first item."""
    now, first = conduct.now, command.params[0]
    if not now.armed:
        return Answer(now.row.refused, "Mission refused: it is not armed")
    if why := conduct.refusal("mission", now_s):
        return Answer(now.row.refused, f"Mission refused: {why}")
    if math.isfinite(first) and first > 0 and not (first == int(first) and conduct.plans.mission.go_to(int(first))):
        return Answer(Ack.DENIED, f"Mission refused: it has no item {first:g}")
    return conduct.choose("mission", now_s)


def _target(conduct: Conduct, command: Command, name: str) -> Vec3 | Answer:
    """The place that a command names, in local NED, above the floor."""
    now = conduct.now
    if not now.flying or not now.located:
        why = "it is not flying" if now.located else "it needs a position estimate"
        return Answer(now.row.refused, f"{name} refused: {why}")
    if _frame(command) in GLOBAL_FRAMES and now.origin is None and math.isnan(command.x) and math.isnan(command.y):
        command = replace(command, frame=1, z=math.nan)
    found = named_place(now, command, name)
    return found if isinstance(found, Answer) else now.above_floor(found)


def _destination(conduct: Conduct, command: Command, name: str) -> Vec3 | Answer:
    """The place that a command names, where the fence lets it be."""
    target, now = _target(conduct, command, name), conduct.now
    if isinstance(target, Answer):
        return target
    if now.params.get("GF_ACTION", 2.0) < 2.0:  # it warns at most
        return target
    why = beyond(now.below_ceiling(target), now, conduct.plans.fence)
    return Answer(Ack.DENIED, f"{name} refused: that is beyond the fence: {why}") if why else target


def _do(conduct: Conduct, what: Hover | Circle, now_s: float, asked: Vec3, name: str) -> Answer:
    """Fly it in the mode that goes to places: guided, or hold. Says so when what was `asked` lies above the ceiling."""
    guided = conduct.now.row.takeoff == "guided"
    answer = conduct.choose("offboard" if guided else "hold", now_s)
    if answer.result is not Ack.ACCEPTED:
        return answer
    conduct.now.lowered(asked, name)
    if isinstance(conduct.activity, Guided):
        conduct.activity.target, conduct.activity.rest = None, what
    else:
        conduct.activity = what
    return answer
