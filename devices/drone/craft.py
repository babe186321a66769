"""The drone as its skills see it: what the autopilot says, and what is asked of it."""

from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from math import dist, hypot

from devices.drone.airspace import Airspace
from devices.drone.endurance import Endurance
from devices.drone.pilot import (
    Answered,
    Found,
    Hover,
    Land,
    News,
    NoLink,
    Order,
    Pictured,
    Pilot,
    Said,
    Setpoint,
    Shoot,
    Steer,
    Telemetry,
)
from wire.messages.command import TrafficOrder
from wire.model import Vec2, Vec3
from wire.site import Robot

LOST_S = 1.6
"""Without a word of the autopilot for this long it is lost; heartbeats come every second."""
COUNTED_M = 0.1
"""Smaller moves are drift and not travelled."""
BRAKE_MPS2 = 1.0
RECENT_S = 6.0
MODE_S = 2.0
"""Heartbeats, which tell the mode, come every second."""
STEERED = ("OFFBOARD", "UNKNOWN")
BY_HAND = ("MANUAL", "ALTCTL", "POSCTL", "ACRO", "STABILIZED")
OTHERS = ("RETURN_TO_LAUNCH", "LAND", "MISSION", "FOLLOW_ME", *BY_HAND)
"""Modes in which the autopilot follows its own plan or a person's sticks."""
ASK_AGAIN_S = 2.5


class Ask:
    """An order that was given: `reason` is None until the autopilot has answered, and empty when it has done it."""

    def __init__(self) -> None:
        self.reason: str | None = None


class Craft:
    """One drone. `now_s` is the mesh's time."""

    def __init__(self, row: Robot, space: Airspace, pilot: Pilot) -> None:
        self.id, self.row, self.space, self.pilot = row.id, row, space, pilot
        self.now_s = 0.0
        self.telemetry: Telemetry | None = None
        self.found: Found | None = None
        self.order: TrafficOrder | None = None
        self.path_m: tuple[Vec2, ...] = ()
        self.path_heights_m: tuple[float, ...] = ()
        self.note, self.fraction = "", 0.0
        self._part = (0.0, 1.0)
        """The part of the goal that is at work."""
        self.travelled_m, self.action_steps = 0.0, 0
        self.pictures: deque[Pictured] = deque(maxlen=16)
        self.home_m: Vec3 | None = None
        """Where it last stood: what it returns to."""
        self.position_m: Vec3 = (*row.start_m, 0.0)
        self.moving = False
        """Under way by an order from here: what `hover` ends."""
        self.steered = False
        """It takes setpoints from here."""
        self.endurance = Endurance()
        self.stop_m: Vec3 | None = None
        """Where it would come to a stand on its way."""
        self._heard_s: float | None = None
        self._counted_m: Vec3 | None = None
        self._asks: dict[int, Ask] = {}
        self._said: deque[tuple[float, str]] = deque(maxlen=16)
        self._landing: Ask | None = None
        self._landing_s = 0.0
        self._other_mode_s: float | None = None
        self.by_hand = False
        """A person has flown it, and has not given it back by another mode; on the ground neither."""

    # What the autopilot says

    def hear(self, news: News) -> None:
        match news:
            case Telemetry():
                self._take(news)
            case Found():
                self.found = news
                self._give_up_asks()
            case Answered():
                if (ask := self._asks.pop(news.order, None)) is not None:
                    ask.reason = news.reason
            case Said() if news.urgent:
                self._said.append((self.now_s, news.text))
            case Pictured():
                self.pictures.append(news)
            case NoLink():
                self._said.append((self.now_s, news.reason))

    @property
    def lost(self) -> bool:
        """Nothing was heard of the autopilot lately."""
        return self._heard_s is None or self.now_s - self._heard_s > LOST_S

    @property
    def airborne(self) -> bool:
        """Not known to stand on the ground with its rotors off or idle."""
        return self.telemetry is not None and self.telemetry.armed and self.telemetry.landed != "on_ground"

    @property
    def yaw_rad(self) -> float:
        return self.telemetry.yaw_rad if self.telemetry is not None else 0.0

    @property
    def velocity_mps(self) -> Vec3:
        return self.telemetry.velocity_enu_mps if self.telemetry is not None else (0.0, 0.0, 0.0)

    @property
    def may_move(self) -> bool:
        """The hub's traffic lets it; on the ground and straight up it is in nobody's way."""
        return self.order is None or self.order.go

    @property
    def level_m(self) -> float | None:
        """The height to travel at that the hub's traffic has given it; None where nobody else flies."""
        return self.order.height_m if self.order is not None else None

    @property
    def cruise_m(self) -> float:
        """Where it flies when nobody says how high."""
        usual_m = self.row.flight_height_m
        return usual_m if self.level_m is None else max(usual_m, min(self.level_m, self.space.top_m(self.position_m)))

    @property
    def column_taken(self) -> bool:
        """Somebody stands or passes under or over it: neither up nor down."""
        return self.order is not None and self.order.column_taken

    @property
    def taken_over(self) -> bool:
        """The autopilot, or a person at its remote control, flies it otherwise than it is steered from here."""
        return self.steered and self._other_mode_s is not None and self.now_s - self._other_mode_s > MODE_S

    @property
    def flown_by_others(self) -> bool:
        """In a mode in which nothing is asked of it from here, and not because it was told to land; on the ground only
        who flies by hand has it."""
        said = self.telemetry
        if self._landing is not None or said is None:
            return False
        return said.mode in (OTHERS if self.airborne else BY_HAND)

    @property
    def mode(self) -> str:
        """Of the autopilot, in words."""
        return self.telemetry.mode.lower().replace("_", " ") if self.telemetry is not None else "another mode"

    def why(self) -> str:
        """What the autopilot warned of in the last seconds, as the end of a sentence; empty when there was nothing."""
        recent = [text for stamp_s, text in self._said if self.now_s - stamp_s < RECENT_S]
        return f": {recent[-1]}" if recent else ""

    # What is asked of it

    def ask(self, order: Order) -> Ask:
        ask = Ask()
        self._asks[self.pilot.ask(order)] = ask
        if not isinstance(order, Shoot):
            self.moving, self.steered = not isinstance(order, Hover), isinstance(order, Steer)
        if isinstance(order, Steer):
            self._other_mode_s, self._landing = self.now_s, None
        return ask

    def fly(self, setpoint: Setpoint) -> None:
        self.pilot.fly(setpoint)

    def hover(self) -> None:
        """Come to a stand and stay in the air. Nothing new once it does, and nothing to whom others fly."""
        if not self.moving:
            return
        others = self.flown_by_others
        where_m, self.stop_m = self.stop_m or self.standing_m, None
        self.moving = self.steered = False
        self.path_m, self.path_heights_m, self._landing = (), (), None
        if self.airborne and not others:
            self.ask(Hover(Setpoint(where_m, (0.0, 0.0, 0.0), self.yaw_rad)))
        elif not others and self.telemetry is not None and self.telemetry.armed:
            self.ask(Land())  # it was about to take off
            self.moving = False

    def begin(self, note: str) -> None:
        """A goal begins."""
        self.note, self.fraction, self._part = note, 0.0, (0.0, 1.0)

    def get_on(self, share: float) -> None:
        """So much of the part at work is done; what has been told is not taken back."""
        begun, ends = self._part
        self.fraction = max(self.fraction, min(1.0, begun + share * (ends - begun)))

    @contextmanager
    def part(self, begins: float, ends: float) -> Iterator[None]:
        """What happens inside is this much of the part at work."""
        whole = self._part
        span = whole[1] - whole[0]
        self._part = (whole[0] + begins * span, whole[0] + ends * span)
        try:
            yield
        finally:
            self._part = whole

    @property
    def standing_m(self) -> Vec3:
        """Where it comes to a stand when it brakes now."""
        vx, vy, vz = self.velocity_mps
        reach = hypot(vx, vy, vz) / (2.0 * BRAKE_MPS2)
        x, y, z = self.position_m
        return (x + vx * reach, y + vy * reach, max(0.3, z + vz * reach))

    def land(self) -> None:
        """Come down here; asked again while the autopilot refuses. Nothing on the ground."""
        if not self.airborne:
            return
        refused = self._landing is not None and bool(self._landing.reason)
        if self._landing is None or (refused and self.now_s - self._landing_s > ASK_AGAIN_S):
            self.path_m, self.path_heights_m, self.stop_m = (), (), None
            self._landing, self._landing_s = self.ask(Land()), self.now_s

    @property
    def landing_refused(self) -> str:
        return (self._landing.reason or "") if self._landing is not None else ""

    @property
    def landing(self) -> bool:
        """It was told to, and is not down yet."""
        return self._landing is not None

    def _take(self, telemetry: Telemetry) -> None:
        self.telemetry, self._heard_s = telemetry, self.now_s
        if telemetry.position_enu_m is not None:
            self.position_m = telemetry.position_enu_m
            self._count(telemetry.position_enu_m)
        self.endurance.take(self.now_s, self.airborne, telemetry.battery, telemetry.battery_left_s)
        self.by_hand = telemetry.mode in BY_HAND and (self.by_hand or self.airborne)
        if telemetry.mode in STEERED:
            self._other_mode_s = None
        elif self._other_mode_s is None:
            self._other_mode_s = self.now_s
        if not telemetry.armed:
            self._landing, self.moving, self.steered = None, False, False
            self.home_m = telemetry.position_enu_m or self.home_m

    def _give_up_asks(self) -> None:
        """A link that was opened anew brings no answers to what was asked over the old one."""
        for ask in self._asks.values():
            ask.reason = "the link was lost before it answered"
        self._asks.clear()

    def _count(self, here_m: Vec3) -> None:
        if self._counted_m is None:
            self._counted_m = here_m
        moved_m = dist(here_m, self._counted_m)
        if moved_m > COUNTED_M:
            self.travelled_m += moved_m
            self._counted_m = here_m
