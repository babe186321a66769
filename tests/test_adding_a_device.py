"""A device that hub and planners have never heard of: announced, found by its skill, given the work."""

from collections.abc import Sequence

from devices.device import Device
from devices.goals_journal import open_journal
from devices.skill import Skill
from devices.worker import Outcome, Pose
from hub.coordinator import Coordinator
from hub.journal import Journal
from planners.core import build
from tests.hub.scenes import flat, seen
from tests.hub.toys import ToyCamera
from wire.bus import Event, Node
from wire.loopback import LoopbackMesh
from wire.messages.command import Command, DeviceCard, Target
from wire.messages.observation import ObjectObservation
from wire.messages.operator import TaskQuery, TaskRequest, TaskState
from wire.model import Message
from wire.site import Site


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

    mesh = LoopbackMesh()
    mesh.add(Coordinator(site, "hub", Journal(None)), "hub", "hub")
    mesh.add(build(site, "planner"), "planner", "planner")
    mesh.add(ToyCamera("cam-1", look), "cctv-1", "cctv")
    mesh.add(SwitchCore(switch), "switch-1", "robot")
    mesh.run(3.0)
    state = mesh.call("task", TaskRequest(task="t-1", instruction="turn off the floor lamp"))
    for _ in range(40):
        mesh.run(0.5)
        state = mesh.call("task_query", TaskQuery(task="t-1"))
        assert isinstance(state, TaskState)
        if state.status not in ("planning", "running"):
            break
    assert state.status == "done", (state.reason, state.refusal, state.log)
    assert not switch.lamp_on
    assert any("switch-1" in line and "toggle_off" in line for line in state.log)
