"""Whatever comes in whatever order: the drone never runs off, and without a goal it hovers, lands or stands."""

from dataclasses import replace
from math import dist
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from devices.drone.airspace import Obstacle
from devices.drone.outlines import Outline
from devices.drone.pilot import Arm, Found, Hover, Land, Order, Setpoint, Shoot, Steer, TakeOff
from devices.worker import Outcome
from tests.devices.drone.scripted import STEP_S, Flown
from wire.messages.command import TrafficOrder

GOALS: tuple[tuple[str, dict[str, object]], ...] = (
    ("take_off", {}),
    ("land", {}),
    ("goto", {"point_m": (6.0, 3.0)}),
    ("goto", {"room": "west", "params": {"height_m": 1.0, "yaw_deg": 45.0}}),
    ("goto", {"point_m": (20.0, 3.0)}),
    ("hold", {"params": {"seconds": 1.0}}),
    ("orbit", {"point_m": (2.0, 2.0), "params": {"radius_m": 0.8}}),
    ("inspect_from_above", {"room": "east"}),
    ("construct_map", {"room": "west", "params": {"spacing_m": 2.0}}),
    ("return_home", {}),
    ("take_picture", {}),
)
REFUSABLE: tuple[type[Order], ...] = (Arm, TakeOff, Land, Steer, Hover, Shoot)
ORDERS: tuple[dict[str, object], ...] = (
    {"go": True},
    {"go": False},
    {"go": True, "step_aside_m": (1.0, 3.0)},
    {"go": True, "step_aside_m": (7.0, 1.0)},
    {"go": True, "column_taken": True},
    {"go": True, "column_taken": True, "land_at_m": (3.0, 3.0)},
    {"go": True, "height_m": 2.1},
)
THINGS: tuple[dict[str, Obstacle], ...] = (
    {},
    {"obj-1": Obstacle(Outline((4.0, 2.0), 0.4), 1.9)},
    {"obj-2": Obstacle(Outline((2.0, 2.0), 0.8), 1.2)},
)
happenings = st.one_of(
    st.tuples(st.just("goal"), st.sampled_from(GOALS)),
    st.tuples(st.just("cancel"), st.none()),
    st.tuples(st.just("time"), st.floats(0.1, 8.0)),
    st.tuples(st.just("no hub"), st.floats(0.1, 15.0)),
    st.tuples(st.just("silence"), st.floats(0.1, 4.0)),
    st.tuples(st.just("refuse"), st.sampled_from(REFUSABLE)),
    st.tuples(st.just("obey"), st.none()),
    st.tuples(st.just("mode"), st.sampled_from(("RETURN_TO_LAUNCH", "POSCTL", "HOLD"))),
    st.tuples(st.just("health"), st.sampled_from(({"located": False}, {"battery": 0.1}, {"battery": 0.9}))),
    st.tuples(st.just("order"), st.sampled_from(ORDERS)),
    st.tuples(st.just("sink"), st.sampled_from((None, 0.2))),
    st.tuples(st.just("climb"), st.sampled_from((None, 0.4))),
    st.tuples(st.just("things"), st.sampled_from(THINGS)),
    st.tuples(st.just("deaf"), st.booleans()),
    st.tuples(st.just("link"), st.none()),
)


class Watched(Flown):
    """Checks after every step what must always be so."""

    goal = False

    def tick(self) -> None:
        before = len(self.pilot.setpoints)
        super().tick()
        assert len(self.pilot.setpoints) == before

    def step(self, hub: bool) -> None:
        self.tick()
        sent = len(self.pilot.setpoints)
        outcome = None
        if not hub:
            self.worker.halt()
        elif self.goal:
            outcome = self.worker.work(self.now_s)
        else:
            self.worker.idle(self.now_s)
        new = self.pilot.setpoints[sent:]
        assert len(new) <= 1
        assert hub or not new, "nothing moves without the hub"
        assert all(0.0 < s.position_enu_m[0] < 8.0 and 0.0 < s.position_enu_m[1] < 4.0 for s in new)
        self._check_speed(new)
        if outcome is not None:
            self._end(outcome)

    def happen(self, kind: str, what: Any) -> None:
        """To the drone and its hub, or to its autopilot."""
        match kind:
            case "goal" if not self.goal and not self.craft.by_hand:
                self.begin(what[0], **what[1])
                self.goal = True
            case "cancel" if self.goal:
                self.drop()
            case "order":
                self.craft.order = TrafficOrder.model_validate({"robot": "drone-1", "seq": 1, "stamp_s": 1.0, **what})
            case "time" | "no hub" | "silence":
                self.pilot.silent = kind == "silence"
                for _ in range(round(what / STEP_S)):
                    self.step(hub=kind != "no hub")
                self.pilot.silent = False
            case _:
                self._befall(kind, what)

    def _befall(self, kind: str, what: Any) -> None:
        match kind:
            case "refuse":
                self.pilot.refusals[what] = "command denied"
            case "obey":
                self.pilot.refusals.clear()
            case "mode":
                self.pilot.says = replace(self.pilot.says, mode=what)
            case "health":
                self.pilot.says = replace(self.pilot.says, **what)
            case "sink":
                self.pilot.sinks_mps = what
            case "climb":
                self.pilot.climbs_mps = what
            case "things":
                self.craft.space.obstacles = what
            case "deaf":
                self.pilot.deaf = what
            case "link":
                self.pilot.tell(Found(1, "px4"))

    def _check_speed(self, new: list[Setpoint]) -> None:
        if new and self.craft.telemetry is not None:
            assert dist(new[0].velocity_enu_mps, (0.0, 0.0, 0.0)) < 1.3

    def _end(self, outcome: Outcome) -> None:
        assert outcome.reason
        assert outcome.status in ("done", "failed")
        self.drop()

    def drop(self) -> None:
        self.goal = False
        self.worker.drop()
        assert not self.craft.steered
        assert self.craft.path_m == ()


@settings(max_examples=60)
@given(st.lists(happenings, min_size=1, max_size=14))
def test_it_stays_in_its_rooms_and_ends_in_hover(events):
    flown = Watched(land_after_s=5.0, idle_home_s=0.0)
    for kind, what in events:
        flown.happen(kind, what)
    if flown.goal:
        flown.drop()
    flown.craft.order = None  # who is told to make way does so
    for _ in range(20):
        flown.step(hub=True)
    moving = [order for order in flown.pilot.orders if not isinstance(order, Shoot | Arm)]
    assert not moving or not isinstance(moving[-1], Steer) or flown.craft.flown_by_others or not flown.craft.airborne


@settings(max_examples=60)
@given(st.lists(happenings, min_size=1, max_size=14))
def test_whatever_was_before_it_lands_when_all_is_well_again(events):
    flown = Watched(land_after_s=5.0, idle_home_s=4.0)
    for kind, what in events:
        flown.happen(kind, what)
    if flown.goal:
        flown.drop()
    flown.craft.order, flown.pilot.deaf = None, False
    flown.pilot.refusals.clear()
    flown.pilot.tell(Found(1, "px4"))
    flown.pilot.says = replace(flown.pilot.says, mode="HOLD", battery=0.9, located=True)
    flown.tick()
    assert flown.do("land").status == "done"
    assert not flown.craft.airborne
