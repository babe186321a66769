"""One goal at a time, a step at a time; and what the drone does by itself: without the hub, and on a low battery."""

from math import dist

from devices.drone.course import CRUISE_MPS
from devices.drone.craft import Craft
from devices.drone.flight import Trouble, fly_to, go_to
from devices.drone.moves import Skilled, go_home, land_here
from devices.drone.places import room_of
from devices.drone.route import nearest_open
from devices.drone.skills import SKILLS
from devices.worker import Outcome, Pose
from wire.messages.command import Command, DeviceCard
from wire.model import Vec2

RADIUS_M = 0.3
LOW_BATTERY = 0.12
"""An idle drone lands with less; one at work is brought down by its autopilot's own failsafe."""
ASIDE_AGAIN_M, ASIDE_SLACK_M = 0.3, 1.0
GET_UP_S = 2.0
THROUGH = object()


class DroneWorker:
    """See devices.worker.Worker."""

    committed = False
    """Whatever it does, it can stop and hover."""

    def __init__(self, craft: Craft) -> None:
        self._craft = craft
        self._skill: Skilled | None = None
        self._away_s: float | None = None
        self._gave_up = ""
        self._aside: Trouble | None = None
        self._aside_m: Vec2 | None = None
        self._asked_s: float | None = None
        """Since when it is in somebody's way where it stands."""
        self._idle_s: float | None = None
        self._homeward: Skilled | None = None
        self._no_way_home = False

    def card(self, boot_id: str) -> DeviceCard:
        return DeviceCard(
            id=self._craft.id,
            kind="drone",
            boot_id=boot_id,
            skills=tuple(skill.card() for skill in SKILLS.values()),
            radius_m=RADIUS_M,
            speed_mps=CRUISE_MPS,
        )

    def fault_of(self, command: Command) -> str:
        skill = SKILLS.get(command.action)
        if skill is None:
            return f"{self._craft.id} cannot {command.action}; it can {', '.join(SKILLS)}"
        if command.room is not None and room_of(self._craft, command.room) is None:
            return f"there is no room {command.room} on the site"
        if self._craft.by_hand:
            return f"{self._craft.id} is flown by hand ({self._craft.mode}): switch its mode to give it back"
        return skill.fault_of(command)

    def begin(self, command: Command) -> None:
        craft = self._craft
        craft.begin(command.action)
        self._gave_up = ""
        self._stay()
        self._skill = SKILLS[command.action].run(craft, command)

    def work(self, now_s: float) -> Outcome | None:
        craft = self._craft
        self._away_s = None
        if craft.lost:
            return Outcome("failed", "driver", f"the autopilot is not heard any more{craft.why()}")
        if self._gave_up:
            craft.land()
            return None if craft.airborne else Outcome("failed", "lost_hub", self._gave_up)
        if self._skill is None or self._step_aside():
            return None
        try:
            next(self._skill)
        except StopIteration as end:
            outcome: Outcome = end.value
            return outcome
        return None

    def idle(self, now_s: float) -> None:
        craft = self._craft
        self._away_s = None
        battery = craft.telemetry.battery if craft.telemetry is not None else None
        if craft.lost or craft.flown_by_others:
            return
        if self._gave_up or (battery is not None and battery < LOW_BATTERY):
            craft.land()
            self._gave_up = self._gave_up if craft.airborne else ""
        elif not self._step_aside(idle=True) and not self._go_home():
            craft.hover()

    def halt(self) -> None:
        """Hover while the hub is away, and after a time land; once it has begun to, it does not stop half-way."""
        craft = self._craft
        self._stay()
        self._away_s = craft.now_s if self._away_s is None else self._away_s
        waited_s = craft.now_s - self._away_s
        if not craft.airborne or craft.lost or craft.flown_by_others:
            return
        if self._gave_up or waited_s >= craft.row.land_after_s:
            self._gave_up = self._gave_up or f"landed after hovering for {waited_s:.0f} s without the hub"
            craft.land()
        else:
            craft.hover()

    def drop(self) -> None:
        if self._skill is not None:
            self._skill.close()
        self._skill = None
        if not self._gave_up:
            self._craft.hover()

    @property
    def pose(self) -> Pose | None:
        craft = self._craft
        if craft.telemetry is None:
            return None
        held = craft.airborne and not craft.may_move
        kept = self._skill is not None and craft.column_taken and not craft.landing and not craft.path_m
        return Pose(
            position_enu_m=craft.position_m,
            yaw_rad=craft.yaw_rad,
            path_m=craft.path_m,
            path_heights_m=craft.path_heights_m,
            travelled_m=craft.travelled_m,
            action_steps=craft.action_steps,
            holding=False,
            standing_by_order=held,
            held_up=held or kept or self._aside_m is not None,
            velocity_enu_mps=craft.velocity_mps,
            airborne=craft.airborne,
            battery=craft.telemetry.battery,
            endurance_s=craft.endurance.full_s,
            lost=craft.lost,
            taken=craft.by_hand,
        )

    @property
    def progress(self) -> tuple[float, str]:
        return (self._craft.fraction, self._craft.note)

    def _go_home(self) -> bool:
        """Whether this step went into flying home and landing, after it has long had nothing to do; where there is no way
        home, it lands where it is."""
        craft = self._craft
        if not craft.airborne:
            self._stay()
            return False
        self._idle_s = craft.now_s if self._idle_s is None else self._idle_s
        if not craft.row.idle_home_s or craft.now_s - self._idle_s < craft.row.idle_home_s:
            return False
        landing = craft.home_m is None or self._no_way_home
        self._homeward = self._homeward or (land_here(craft) if landing else go_home(craft))
        try:
            next(self._homeward)
        except StopIteration as end:
            self._no_way_home = end.value.status == "failed" and not landing
            self._homeward = None
            if not self._no_way_home:
                self._stay()
        return True

    def _stay(self) -> None:
        """It is not on its way home, and has only begun to be idle."""
        if self._homeward is not None:
            self._homeward.close()
        self._homeward = self._idle_s = None
        self._no_way_home = False

    def _step_aside(self, idle: bool = False) -> bool:
        """Whether this step went into clearing the way for somebody. With nothing to do it gets up from the ground for
        whoever waits; once up, it is mostly out of the way already."""
        craft = self._craft
        wanted = craft.order.step_aside_m if craft.order is not None else None
        if not self._is_waited_for(wanted, idle):
            wanted = None
        if wanted is None or craft.landing:
            if self._aside_m is not None:
                self._aside = self._aside_m = None
                craft.hover()
            return False
        if self._aside_m is None or dist(wanted, self._aside_m) > ASIDE_AGAIN_M:
            height_m = max(craft.position_m[2], min(craft.row.flight_height_m, craft.space.top_m(craft.position_m)))
            goal_m = nearest_open(craft.space, (*wanted, height_m), ASIDE_SLACK_M)
            craft.hover()
            go = fly_to if craft.airborne else go_to
            self._aside_m, self._aside = wanted, go(craft, goal_m) if goal_m is not None else None
        if self._aside is not None and next(self._aside, THROUGH) is THROUGH:
            self._aside = None
            craft.hover()
        return True

    def _is_waited_for(self, wanted_m: Vec2 | None, idle: bool) -> bool:
        """Whether making way is worth it: from the ground, only for one that does not just pass by."""
        craft = self._craft
        if wanted_m is None or craft.airborne or not idle:
            self._asked_s = None
            return craft.airborne
        self._asked_s = craft.now_s if self._asked_s is None else self._asked_s
        return self._aside_m is not None or craft.now_s - self._asked_s >= GET_UP_S
