"""A drone's core on a mesh in memory: what it reports, what it tells, and what it does when it is stopped."""

from collections.abc import Sequence
from dataclasses import replace

import pytest

from devices.drone.core import DroneCore
from devices.drone.pilot import Land, NoLink, Said
from devices.goals_journal import open_journal
from tests.devices.drone.flat import flat
from tests.devices.drone.scripted import ScriptedPilot
from wire.bus import Event, Node, Received
from wire.loopback import LoopbackMesh
from wire.messages.command import Command, RobotReport, TrafficOrder
from wire.messages.observation import EventLog
from wire.site import SiteError


class Hub:
    """Gives signs of life and one goal, and listens."""

    def __init__(self, action: str) -> None:
        self.reports: list[RobotReport] = []
        self.lines: list[str] = []
        self._action, self._asked = action, False

    def start(self, node: Node) -> None:
        self._node = node
        node.subscribe("robot_report")
        node.subscribe("event")
        node.serve("snapshot")

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        for event in events:
            if isinstance(event, Received) and isinstance(event.message, RobotReport):
                self.reports.append(event.message)
            if isinstance(event, Received) and isinstance(event.message, EventLog):
                self.lines.append(event.message.text)
        self._node.publish("traffic", TrafficOrder(robot="drone-1", seq=1, stamp_s=now_s, go=True), "drone-1")
        if not self._asked and now_s > 1.0:
            self._asked = True
            given = {"epoch": 1, "robot": "drone-1", "action": self._action, "valid_until_s": 1e6, "timeout_s": 60.0}
            self._node.ask("goal", Command.model_validate({"goal_id": "g-1", **given}), "drone-1")

    def stop(self) -> None: ...


def flying(seconds: float) -> tuple[ScriptedPilot, DroneCore, Hub, LoopbackMesh]:
    pilot, hub, mesh = ScriptedPilot(), Hub("take_off"), LoopbackMesh()
    core = DroneCore(flat(), "drone-1", open_journal(), lambda row: pilot)
    mesh.add(hub, "hub", "hub")
    mesh.add(core, "drone-1", "robot")
    mesh.run(seconds)
    return pilot, core, hub, mesh


def test_what_people_should_know_stands_in_its_log_too(caplog):
    """Where `./justw logs` looks, and docs/fly-a-real-drone.md sends people."""
    with caplog.at_level("INFO"):
        flying(1.0)
    assert "found an autopilot: system 1, px4; ready" in caplog.text


def test_an_autopilot_that_never_was_is_missed_once() -> None:
    pilot, hub, mesh = ScriptedPilot(), Hub("hold"), LoopbackMesh()
    pilot.news = list  # type: ignore[method-assign]
    mesh.add(hub, "hub", "hub")
    mesh.add(DroneCore(flat(), "drone-1", open_journal(), lambda row: pilot), "drone-1", "robot")
    mesh.run(20.0)
    assert [line for line in hub.lines if "autopilot" in line] == [
        "no autopilot is heard at udpin://127.0.0.1:14540 yet"
    ]


def test_it_reports_ten_times_a_second_where_it_is_and_how_full():
    _, _, hub, _ = flying(6.0)
    assert 50 <= len(hub.reports) <= 62
    first, last = hub.reports[0], hub.reports[-1]
    assert (first.airborne, first.status, first.battery) == (False, "idle", 0.9)
    assert last.airborne
    assert last.position_enu_m == (1.0, 1.0, 1.5)
    assert last.velocity_enu_mps == (0.0, 0.0, 0.0)
    assert any("found an autopilot: system 1, px4; ready" in line for line in hub.lines)


def test_a_lost_autopilot_is_reported_and_told_of():
    pilot, _, hub, mesh = flying(6.0)
    pilot.silent = True
    mesh.run(2.0)
    assert hub.reports[-1].status == "lost"
    assert hub.lines[-1] == "the autopilot at udpin://127.0.0.1:14540 is not heard any more"
    pilot.silent = False
    mesh.run(0.5)
    assert hub.reports[-1].status == "idle"


def test_a_drone_that_is_flown_by_hand_is_out_of_the_fleet_and_says_so():
    pilot, _, hub, mesh = flying(6.0)
    pilot.says = replace(pilot.says, mode="ALTCTL")
    mesh.run(1.0)
    assert hub.reports[-1].status == "fault"
    assert "a person flies it: left alone until its mode is switched (altctl)" in hub.lines
    pilot.says = replace(pilot.says, mode="HOLD")
    mesh.run(1.0)
    assert hub.reports[-1].status == "idle"
    assert "given back (hold)" in hub.lines


def test_what_the_autopilot_warns_of_is_passed_on_once():
    pilot, _, hub, mesh = flying(2.0)
    for _ in range(3):
        pilot.tell(Said("Battery low", urgent=True))
        pilot.tell(Said("a detail", urgent=False))
    pilot.tell(NoLink("connection refused"))
    mesh.run(0.5)
    assert hub.lines.count("the autopilot says: Battery low") == 1
    assert "the link udpin://127.0.0.1:14540 cannot be opened: connection refused" in hub.lines
    assert not any("a detail" in line for line in hub.lines)


def test_a_process_that_is_stopped_lands_what_is_in_the_air():
    pilot, core, _, _ = flying(6.0)
    core.stop()
    assert isinstance(pilot.orders[-1], Land)
    pilot, core, _, _ = flying(0.5)
    core.stop()
    assert pilot.orders == []


def test_another_kind_is_not_flown():
    site = flat()
    lift = replace_kind(site, "lift")
    with pytest.raises(SiteError, match="drone-1 is a lift in the site file: a drone is flown here"):
        DroneCore(lift, "drone-1", open_journal(), lambda row: ScriptedPilot())
    with pytest.raises(SiteError, match="the site has no robot drone-2"):
        DroneCore(site, "drone-2", open_journal(), lambda row: ScriptedPilot())


def replace_kind(site, kind):
    return site.model_copy(update={"robot": (site.robot[0].model_copy(update={"kind": kind}),)})


def test_a_report_says_what_was_last_known():
    pilot, _, hub, mesh = flying(6.0)
    pilot.says = replace(pilot.says, position_enu_m=None, located=False)
    mesh.run(1.0)
    assert hub.reports[-1].position_enu_m == (1.0, 1.0, 1.5)
