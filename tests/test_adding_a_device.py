"""Devices that hub and planners have never heard of: announced, found by their skills, given the work."""

import importlib
import re
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from types import ModuleType

import pytest

import devices
from devices.device import Device
from devices.goals_journal import open_journal
from devices.quadruped.core import QuadrupedCore
from devices.skill import Skill
from devices.worker import Outcome, Pose
from hub.coordinator import Coordinator
from hub.journal import Journal
from planners.core import build
from tests.hub.scenes import flat, seen
from tests.hub.toys import ToyCamera
from tests.pages import ROOT, blocks, files
from wire.bus import CannotRun, Core, Event, Node
from wire.loopback import LoopbackMesh
from wire.messages.command import Command, DeviceCard, Target
from wire.messages.observation import ObjectObservation
from wire.messages.operator import TaskQuery, TaskRequest, TaskState
from wire.model import Message
from wire.site import Site, SiteError, parse_site


class Switchable(Message):
    target: Target


class WallSwitch:
    """A switch in the wall: turns off what hangs on its circuit, from where it is."""

    def __init__(self) -> None:
        self.lamp_on = True
        self._command: Command | None = None
        self._skill = Skill("toggle_off", Switchable, self.toggle_off)

    def toggle_off(self) -> None:
        """Turn off a lamp on this circuit."""
        self.lamp_on = False

    def card(self, boot_id: str) -> DeviceCard:
        return DeviceCard(
            id="switch-1", kind="wallswitch", boot_id=boot_id, skills=(self._skill.card(),), speed_mps=0.5
        )

    def fault_of(self, command: Command) -> str:
        return self._skill.fault_of(command) if command.action == "toggle_off" else "a switch only turns off"

    def begin(self, command: Command) -> None:
        self._command = command

    def work(self, now_s: float) -> Outcome | None:
        self._skill.run()
        return Outcome("done", "ok", "off")

    def idle(self, now_s: float) -> None: ...

    def halt(self) -> None: ...

    def drop(self) -> None:
        self._command = None

    committed = False
    progress = (1.0, "")
    pose = Pose((1.0, 1.0, 1.2), 0.0, (), 0.0, 0, holding=False, standing_by_order=False)


class SwitchCore:
    """The process of the new device: the shell that every device has, around its own worker."""

    def __init__(self, worker: WallSwitch) -> None:
        self._device = Device("switch-1", worker, open_journal(), lost_hub_s=2.0)

    def start(self, node: Node) -> None:
        node.subscribe("traffic", "switch-1")  # a sign of life of the hub
        self._device.start(node)

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        for event in events:
            self._device.hear(event, now_s)
        self._device.step(now_s)

    def stop(self) -> None: ...


def _site() -> Site:
    site = flat()
    robot = site.robot[0].model_copy(update={"id": "switch-1"})
    return site.model_copy(update={"robot": (robot,)})


def test_a_new_kind_of_device_gets_the_work_that_its_skill_is_for() -> None:
    site, switch = _site(), WallSwitch()

    def look(now_s: float) -> Sequence[ObjectObservation]:
        return [seen("FloorLamp", 2.0, 2.0, 0.9, "lamp", isToggled=0.97 if switch.lamp_on else 0.03)]

    state = _asked(site, SwitchCore(switch), "turn off the floor lamp", look)
    assert state.status == "done", (state.reason, state.refusal, state.log)
    assert not switch.lamp_on
    assert any("switch-1" in line and "toggle_off" in line for line in state.log)


def _asked(
    site: Site, device: Core, instruction: str, look: Callable[[float], Sequence[ObjectObservation]]
) -> TaskState:
    """How a task ends on a mesh of a hub, the scripted planner, a camera and this one device."""
    mesh = LoopbackMesh()
    mesh.add(Coordinator(site, "hub", Journal(None)), "hub", "hub")
    mesh.add(build(site, "planner"), "planner", "planner")
    mesh.add(ToyCamera("cam-1", look), "cctv-1", "cctv")
    mesh.add(device, site.robot[0].id, "robot")
    mesh.run(3.0)
    mesh.call("task", TaskRequest(task="t-1", instruction=instruction))
    for _ in range(60):
        mesh.run(0.5)
        state = mesh.call("task_query", TaskQuery(task="t-1"))
        assert isinstance(state, TaskState)
        if state.status not in ("planning", "running"):
            return state
    raise AssertionError(f"{instruction}: still {state.status}: {state.log}")


# The page docs/add-a-device.md, word for word.


@pytest.fixture
def lift(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    """`devices.lift.__main__`, from the page's files."""
    for name, text in files("add-a-device.md").items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    (tmp_path / "devices/lift/__init__.py").touch()
    monkeypatch.setattr(devices, "__path__", [*devices.__path__, str(tmp_path / "devices")])
    monkeypatch.setenv("R2X_STATE", str(tmp_path / "state"))
    yield importlib.import_module("devices.lift.__main__")
    for name in [name for name in sys.modules if name.startswith("devices.lift")]:
        monkeypatch.delitem(sys.modules, name)


def _site_of_the_page() -> Site:
    """The flat of the tests with the tables that the page appends."""
    (tables,) = (text for text in blocks("add-a-device.md", "toml") if "[[robot]]" in text)
    flat_site = flat().model_copy(update={"robot": ()})
    rows = tomllib.loads(tables)
    data = flat_site.model_dump(exclude_unset=True) | {"robot": rows["robot"]}
    return parse_site(data | {"process": [*data["process"], *rows["process"]]}, "the page")


def _stand(now_s: float) -> Sequence[ObjectObservation]:
    return [seen("TVStand", 2.0, 2.0, 0.3, "stand")]


def test_the_device_of_the_page_is_asked_for_what_only_it_can_do(lift: ModuleType) -> None:
    site = _site_of_the_page()
    core = lift.build(site, "lift-1")
    state = _asked(site, core, "do raise_stand on the TV stand height_m=1.1", _stand)
    assert state.status == "done", (state.reason, state.refusal, state.log)
    assert state.reason == "every step is done"
    assert core.lift.height_m == pytest.approx(1.1)
    assert any("lift-1: raise_stand" in line for line in state.log)


@pytest.mark.parametrize(
    ("instruction", "reason"),
    [
        ("do raise_stand on the TV stand height_m=3", "height_m: Input should be less than or equal to 1.25"),
        ("do raise_stand on the TV stand", "height_m is missing; it takes height_m, object"),
        ("do lower_stand on the TV stand", "no robot here announces the skill lower_stand; .* raise_stand"),
    ],
)
def test_the_device_of_the_page_says_what_it_cannot_do(lift: ModuleType, instruction: str, reason: str) -> None:
    site = _site_of_the_page()
    state = _asked(site, lift.build(site, "lift-1"), instruction, _stand)
    assert state.status in ("failed", "refused")
    assert re.search(reason, state.reason), state.reason


@pytest.mark.parametrize("name", files("add-a-device.md"))
@pytest.mark.parametrize(
    "rule",
    [("check", "--config", 'lint.isort.known-first-party=["devices"]'), ("format", "--check")],
    ids=lambda r: r[0],
)
def test_the_code_of_the_page_keeps_the_rules_of_the_tree(name: str, rule: tuple[str, ...]) -> None:
    command = [sys.executable, "-m", "ruff", *rule, "--no-cache", "--stdin-filename", name, "-"]
    text = files("add-a-device.md")[name]
    done = subprocess.run(command, input=text, capture_output=True, text=True, cwd=ROOT)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_card_with_another_id_than_its_process_is_refused(lift: ModuleType) -> None:
    site = _site_of_the_page()
    mesh = LoopbackMesh()
    mesh.add(lift.build(site, "lift-1"), "lift-2", "robot")
    with pytest.raises(CannotRun, match="process lift-2 serves the device lift-1 with a card of lift-1: build"):
        mesh.run(0.1)


def test_a_quadrupeds_process_drives_no_other_kind() -> None:
    with pytest.raises(SiteError, match="lift-1 is a lift in the site file: a quadruped is driven here"):
        QuadrupedCore(_site_of_the_page(), "lift-1", open_journal())
