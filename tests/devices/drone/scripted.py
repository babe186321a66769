"""A pilot whose autopilot does at once what it is told, unless the test says otherwise."""

from dataclasses import replace

from devices.drone.airspace import Airspace
from devices.drone.craft import Craft
from devices.drone.pilot import (
    Answered,
    Arm,
    Disarm,
    Found,
    Hover,
    Land,
    News,
    Order,
    Pictured,
    Setpoint,
    Shoot,
    Steer,
    TakeOff,
    Telemetry,
)
from devices.drone.work import DroneWorker
from devices.worker import Outcome
from tests.devices.drone.flat import flat
from wire.messages.command import Command

STEP_S = 0.05
STANDING = Telemetry((1.0, 1.0, 0.0), (0.0, 0.0, 0.0), 0.0, False, "on_ground", "HOLD", 0.9, True, True)


class ScriptedPilot:
    """`refusals`: by the type of an order, what the autopilot answers instead of doing it."""

    def __init__(self) -> None:
        self.orders: list[Order] = []
        self.setpoints: list[Setpoint] = []
        self.refusals: dict[type[Order], str] = {}
        self.says = STANDING
        self.silent = False
        self.deaf = False
        """Orders do not reach the autopilot, and nobody answers."""
        self.picture = Pictured(7, True)
        self.sinks_mps: float | None = None
        """So fast it comes down when it is told to land; at once when it is None."""
        self.climbs_mps: float | None = None
        """So fast it takes off; at once when it is None."""
        self._up_m: float | None = None
        self._news: list[News] = [Found(1, "px4")]

    def start(self) -> None: ...

    def stop(self) -> None: ...

    def ask(self, order: Order) -> int:
        self.orders.append(order)
        if self.deaf:
            return len(self.orders)
        refusal = self.refusals.get(type(order), "")
        if not refusal:
            self._do(order)
        self.tell(Answered(len(self.orders), refusal))
        return len(self.orders)

    def fly(self, setpoint: Setpoint) -> None:
        self.setpoints.append(setpoint)
        if self.says.mode == "OFFBOARD":
            self.says = replace(
                self.says,
                position_enu_m=setpoint.position_enu_m,
                velocity_enu_mps=setpoint.velocity_enu_mps,
                yaw_rad=setpoint.yaw_rad,
            )

    def tell(self, news: News) -> None:
        self._news.append(news)

    def news(self) -> list[News]:
        news, self._news = self._news, []
        if self.says.landed == "landing":
            self._sink()
        if self._up_m is not None:
            self._climb(self._up_m)
        return [] if self.silent else [*news, self.says]

    def _sink(self) -> None:
        x, y, z = self.says.position_enu_m or (0.0, 0.0, 0.0)
        lower_m = z - (self.sinks_mps or 0.0) * STEP_S
        if lower_m > 0.0:
            self.says = replace(self.says, position_enu_m=(x, y, lower_m))
        else:
            self._touch_down(x, y)

    def _climb(self, up_m: float) -> None:
        x, y, z = self.says.position_enu_m or (0.0, 0.0, 0.0)
        if self.says.mode == "TAKEOFF" and z < up_m:
            higher_m = min(up_m, z + (self.climbs_mps or 0.0) * STEP_S)
            self.says = replace(self.says, position_enu_m=(x, y, higher_m), landed="taking_off")
        else:
            self._up_m = None

    def _touch_down(self, x: float, y: float) -> None:
        self.says = replace(self.says, position_enu_m=(x, y, 0.0), landed="on_ground", armed=False, mode="LAND")

    def _do(self, order: Order) -> None:
        x, y, z = self.says.position_enu_m or (0.0, 0.0, 0.0)
        match order:
            case Arm() | Disarm():
                self.says = replace(self.says, armed=isinstance(order, Arm))
            case TakeOff() if self.climbs_mps is not None:
                self._up_m = z + order.height_m
                self.says = replace(self.says, mode="TAKEOFF")
            case TakeOff():
                up_m = (x, y, z + order.height_m)
                self.says = replace(self.says, position_enu_m=up_m, landed="in_air", mode="HOLD")
            case Land() if self.sinks_mps is not None:
                self.says = replace(self.says, landed="landing", mode="LAND")
            case Land():
                self._touch_down(x, y)
            case Steer():
                self.says = replace(self.says, mode="OFFBOARD", landed="in_air")
            case Hover():
                self.says = replace(self.says, mode="HOLD", landed="in_air", velocity_enu_mps=(0.0, 0.0, 0.0))
            case Shoot():
                self.tell(self.picture)


class Flown:
    """A drone's worker in its two rooms, stepped through time."""

    def __init__(self, **robot: object) -> None:
        site = flat(**robot)
        self.pilot = ScriptedPilot()
        self.craft = Craft(site.robot[0], Airspace(site), self.pilot)
        self.worker = DroneWorker(self.craft)
        self.now_s = 100.0
        self.tick()

    def tick(self) -> None:
        self.now_s += STEP_S
        self.craft.now_s = self.now_s
        for news in self.pilot.news():
            self.craft.hear(news)

    def begin(self, action: str, **fields: object) -> None:
        fault = self.fault_of(action, **fields)
        assert not fault, fault
        self.worker.begin(_command(action, **fields))

    def fault_of(self, action: str, **fields: object) -> str:
        return self.worker.fault_of(_command(action, **fields))

    def work(self, seconds: float) -> Outcome | None:
        """Until the goal ends, or that long."""
        for _ in range(round(seconds / STEP_S)):
            self.tick()
            outcome = self.worker.work(self.now_s)
            if outcome is not None:
                self.worker.drop()
                return outcome
        return None

    def do(self, action: str, **fields: object) -> Outcome:
        self.begin(action, **fields)
        outcome = self.work(200.0)
        assert outcome is not None, f"not done after 200 s: {self.worker.progress}"
        return outcome

    def pause(self, seconds: float, hub: bool = False) -> None:
        """Time without a goal, or without the hub."""
        for _ in range(round(seconds / STEP_S)):
            self.tick()
            if hub:
                self.worker.halt()
            else:
                self.worker.idle(self.now_s)


def _command(action: str, **fields: object) -> Command:
    given = {"epoch": 1, "robot": "drone-1", "valid_until_s": 1e6, "timeout_s": 60.0, **fields}
    return Command.model_validate({"goal_id": "g-1", "action": action, **given})


def kinds(flown: Flown) -> list[str]:
    """The names of all orders that it was given."""
    return [type(order).__name__ for order in flown.pilot.orders]
