"""Camera and gimbal as the autopilot orders them about: by a mission's items, and by older commands that name it."""

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.autopilot.interface import Ack, Command, Item, Severity
from sim.mavlink.camera import Camera
from sim.mavlink.craft import AUTOPILOT, Craft, Sender
from sim.mavlink.gimbal import Gimbal

OLDER = frozenset(
    {
        mav.MAV_CMD_DO_DIGICAM_CONTROL,
        mav.MAV_CMD_DO_MOUNT_CONFIGURE,
        mav.MAV_CMD_DO_MOUNT_CONTROL,
        mav.MAV_CMD_DO_SET_CAM_TRIGG_DIST,
        mav.MAV_CMD_DO_SET_CAM_TRIGG_INTERVAL,
        mav.MAV_CMD_DO_TRIGGER_CONTROL,
    }
)
"""From before there were components: ground stations send them to the autopilot."""


class Payload:
    """They do what the autopilot says also where they do not show themselves as components."""

    def __init__(self, craft: Craft) -> None:
        self._craft = craft
        self.camera, self.gimbal = Camera(craft), Gimbal(craft)

    def check(self, item: Item) -> int:
        """MAV_MISSION_RESULT of a mission's item, as far as camera and gimbal are concerned."""
        wrong = self._wrong(_command(item))
        return int(mav.MAV_MISSION_INVALID_PARAM1) + wrong - 1 if wrong else int(mav.MAV_MISSION_ACCEPTED)

    def _wrong(self, command: Command) -> int | None:
        by_camera = self.camera.wrong(command)
        return self.gimbal.wrong(command) if by_camera is None else by_camera

    def older(self, command: Command, sender: Sender, now_s: float) -> Ack | None:
        """None for what is not one of the older commands."""
        return self._order(command, (sender.sysid, sender.compid), now_s) if command.id in OLDER else None

    def _order(self, command: Command, who: tuple[int, int], now_s: float) -> Ack | None:
        for part in (self.camera, self.gimbal):
            result = part.order(command, who, now_s)
            if result is not None:
                return result
        return None

    def step(self, now_s: float) -> None:
        """What the mission has come to; then both go on."""
        for command in self._craft.autopilot.payload():
            result = self._order(command, (self._craft.sysid, AUTOPILOT), now_s)
            if result is not Ack.ACCEPTED:
                self._craft.say(Severity.WARNING, f"Mission: command {command.id} failed")
        self.camera.step(now_s)
        self.gimbal.step(now_s)


def _command(item: Item) -> Command:
    return Command(item.command, item.params, item.x, item.y, item.z, item.frame)
