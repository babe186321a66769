"""The command protocol: every command that is meant for the autopilot gets exactly one acknowledgement at once."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Protocol

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.autopilot.interface import Ack, Answer, Command
from sim.mavlink import modes, newer, streams
from sim.mavlink.craft import AUTOPILOT, Craft, Sender
from sim.mavlink.gimbal import REGIONS
from sim.mavlink.items import scale
from sim.mavlink.pack import i32
from sim.mavlink.payload import Payload
from sim.mavlink.peer import Message, Peer
from sim.mavlink.streams import Rates

UNUSED_INT = 0x7FFF_FFFF
MOST_REMEMBERED = 32
REPORT_S = 0.5
"""From one report of a command in progress to the next."""


class Component(Protocol):
    """A camera or a gimbal of the vehicle, with commands of its own."""

    compid: int

    def command(self, command: Command, sender: Sender, now_s: float) -> Ack | None:
        """None for what it does not know."""
        ...

    def message(self, message_id: int, sender: Sender, now_s: float) -> Message | None:
        """What REQUEST_MESSAGE asks for; None when it has no such message."""
        ...


def read(message: Message) -> Command:
    """COMMAND_LONG or COMMAND_INT."""
    params = (message.param1, message.param2, message.param3, message.param4)
    if message.get_msgId() == mav.MAVLINK_MSG_ID_COMMAND_LONG:
        return Command(message.command, params, message.param5, message.param6, message.param7, None)
    divide = scale(message.command, message.frame)
    x, y = (math.nan if value == UNUSED_INT else value / divide for value in (message.x, message.y))
    return Command(message.command, params, x, y, message.z, message.frame)


def number(value: float) -> int | None:
    """A parameter that stands for a whole number; None when it does not."""
    return int(value) if math.isfinite(value) and value == int(value) else None


class Commands:
    """One vehicle's commands; `rates` finds a peer's streams."""

    def __init__(self, craft: Craft, rates: Callable[[Peer], Rates], payload: Payload) -> None:
        self._craft = craft
        self._rates = rates
        self._payload = payload
        self._components: list[Component] = [payload.camera, payload.gimbal] if craft.camera else []
        self._running: dict[int, Sender] = {}
        self._reported_s = -math.inf
        self._own: dict[int, Callable[[Command, Sender, float], Answer]] = {
            mav.MAV_CMD_SET_MESSAGE_INTERVAL: self._set_interval,
            mav.MAV_CMD_GET_MESSAGE_INTERVAL: self._get_interval,
            mav.MAV_CMD_REQUEST_MESSAGE: self._request,
            mav.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES: self._asked_of,
            mav.MAV_CMD_REQUEST_PROTOCOL_VERSION: self._asked_of,
            mav.MAV_CMD_GET_HOME_POSITION: self._home,
            mav.MAV_CMD_DO_SET_MODE: self._set_mode,
            mav.MAV_CMD_DO_SET_STANDARD_MODE: self._set_standard_mode,
        }

    def handle(self, message: Message, sender: Sender, now_s: float) -> None:
        """COMMAND_LONG or COMMAND_INT for this vehicle."""
        command = read(message)
        if message.target_component > AUTOPILOT:
            self._component(message.target_component, command, sender, now_s)
            return
        own = self._own.get(command.id)
        if own is None and message.target_component == 0 and self._camera_takes(command, sender, now_s):
            return
        answer = own(command, sender, now_s) if own else self._others(command, sender, now_s)
        self._ack(command.id, answer.result, sender)
        if answer.result == Ack.IN_PROGRESS:
            if len(self._running) >= MOST_REMEMBERED:
                self._running.clear()
            self._running[command.id] = sender
        if answer.text:
            self._craft.complain(answer.text, now_s)
        if answer.result == Ack.ACCEPTED:
            self._follow_up(command, sender, now_s)

    def _others(self, command: Command, sender: Sender, now_s: float) -> Answer:
        """The older commands of camera and gimbal; what is left is the autopilot's."""
        older = self._payload.older(command, sender, now_s)
        return self._craft.autopilot.command(command, now_s) if older is None else Answer(older)

    def _follow_up(self, command: Command, sender: Sender, now_s: float) -> None:
        """What was asked for goes out after the acknowledgement."""
        match command.id:
            case mav.MAV_CMD_REQUEST_MESSAGE if command.params[0] == newer.AVAILABLE_MODES:
                for message in self._modes(command):
                    self._craft.reply(sender, message)
            case mav.MAV_CMD_REQUEST_MESSAGE:
                self._send(int(command.params[0]), sender, now_s)
            case mav.MAV_CMD_REQUEST_PROTOCOL_VERSION:
                self._send(newer.PROTOCOL_VERSION, sender, now_s)
            case mav.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES:
                self._send(streams.VERSION, sender, now_s)
            case mav.MAV_CMD_GET_HOME_POSITION:
                self._send(streams.HOME, sender, now_s)
            case mav.MAV_CMD_GET_MESSAGE_INTERVAL:
                self._send_interval(int(command.params[0]), sender)

    def _ack(self, command: int, result: Ack, to: Sender, progress: int = 0, compid: int = AUTOPILOT) -> None:
        ack = mav.MAVLink_command_ack_message(command, int(result), progress, 0, to.sysid, to.compid)
        self._craft.reply(to, ack, compid)

    def _component(self, compid: int, command: Command, sender: Sender, now_s: float) -> None:
        """For a camera or gimbal; a component that is not here does not answer."""
        for component in self._components:
            if component.compid == compid:
                result = self._ask(component, command, sender, now_s)
                self._ack(command.id, Ack.UNSUPPORTED if result is None else result, sender, compid=compid)

    def _ask(self, component: Component, command: Command, sender: Sender, now_s: float) -> Ack | None:
        if command.id != mav.MAV_CMD_REQUEST_MESSAGE:
            return component.command(command, sender, now_s)
        wanted = number(command.params[0])
        message = None if wanted is None else component.message(wanted, sender, now_s)
        if message is None:
            return None
        self._craft.reply(sender, message, component.compid)
        return Ack.ACCEPTED

    def _camera_takes(self, command: Command, sender: Sender, now_s: float) -> bool:
        """A command to all components, taken by the first that knows it."""
        for component in self._components if command.id not in REGIONS else ():
            result = component.command(command, sender, now_s)
            if result is not None:
                self._ack(command.id, result, sender, compid=component.compid)
                return True
        return False

    def _set_interval(self, command: Command, sender: Sender, now_s: float) -> Answer:
        wanted = number(command.params[0])
        if wanted is None or not math.isfinite(command.params[1]):
            return Answer(Ack.DENIED)
        return Answer(Ack.ACCEPTED if self._rates(sender.peer).ask(wanted, command.params[1]) else Ack.DENIED)

    def _get_interval(self, command: Command, sender: Sender, now_s: float) -> Answer:
        wanted = number(command.params[0])
        return Answer(Ack.ACCEPTED if wanted is not None and 0 <= wanted <= 0xFFFF else Ack.DENIED)

    def _send_interval(self, message_id: int, sender: Sender) -> None:
        if message_id not in streams.MESSAGES:
            interval_us = 0
        else:
            interval_s = self._rates(sender.peer).interval_s(message_id)
            interval_us = -1 if math.isinf(interval_s) else i32(interval_s * 1e6)
        self._craft.reply(sender, mav.MAVLink_message_interval_message(message_id, interval_us))

    def _request(self, command: Command, sender: Sender, now_s: float) -> Answer:
        wanted = number(command.params[0])
        if wanted == newer.AVAILABLE_MODES and self._craft.personality.listed:
            return Answer(Ack.ACCEPTED if self._modes(command) else Ack.DENIED)
        if wanted is None or not streams.has(self._craft, wanted):
            return Answer(Ack.UNSUPPORTED)
        if wanted == streams.HOME:
            self._craft.home_asked = True
        there = streams.build(self._craft, wanted, self._craft.autopilot.telemetry(now_s))
        return Answer(Ack.ACCEPTED if there is not None else Ack.TEMPORARILY_REJECTED)

    def _send(self, message_id: int, sender: Sender, now_s: float) -> None:
        message = streams.build(self._craft, message_id, self._craft.autopilot.telemetry(now_s))
        if message is not None:
            self._craft.reply(sender, message)

    def _home(self, command: Command, sender: Sender, now_s: float) -> Answer:
        """What REQUEST_MESSAGE of HOME_POSITION has replaced; MAVROS and older stations still send it."""
        return self._request(replace(command, params=(float(streams.HOME), 0.0, 0.0, 0.0)), sender, now_s)

    def _asked_of(self, command: Command, sender: Sender, now_s: float) -> Answer:
        """The older requests for one message, which is asked for by a 1."""
        return Answer(Ack.ACCEPTED if command.params[0] == 1 else Ack.DENIED)

    def _set_mode(self, command: Command, sender: Sender, now_s: float) -> Answer:
        """PX4's custom mode comes as main and sub mode, ArduPilot's as one number."""
        base, main = number(command.params[0]), number(command.params[1])
        sub = number(0.0 if math.isnan(command.params[2]) else command.params[2])
        if base is None or main is None or sub is None or not all(0 <= value <= 0xFFFF for value in (base, main, sub)):
            return Answer(Ack.DENIED)
        if self._craft.personality.name == "px4":
            main = (main & 0xFF) << 16 | (sub & 0xFF) << 24
        return self._craft.autopilot.set_mode(base, main, now_s)

    def _modes(self, command: Command) -> list[Message]:
        """Those that a request asks for: of one number, or of all."""
        index = number(0.0 if math.isnan(command.params[1]) else command.params[1])
        return [] if index is None else modes.available(self._craft, index)

    def _set_standard_mode(self, command: Command, sender: Sender, now_s: float) -> Answer:
        """Param 1 is a MAV_STANDARD_MODE."""
        rows = self._craft.personality.listed
        if not rows:
            return Answer(Ack.UNSUPPORTED)
        row = next((each for each in rows if each.standard and each.standard == command.params[0]), None)
        if row is None:
            return Answer(Ack.DENIED, f"Mode change refused: there is no standard mode {command.params[0]:g}")
        return self._craft.autopilot.set_mode(mav.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, row.custom_mode, now_s)

    def set_mode(self, message: Message, sender: Sender, now_s: float) -> None:
        """SET_MODE, the message: ArduPilot acknowledges it like the command."""
        answer = self._craft.autopilot.set_mode(message.base_mode, message.custom_mode, now_s)
        self._ack(mav.MAVLINK_MSG_ID_SET_MODE, answer.result, sender)
        if answer.text:
            self._craft.complain(answer.text, now_s)

    def step(self, now_s: float) -> None:
        """Report how commands in progress go, to those who gave them."""
        for command, result, percent in self._craft.autopilot.progress():
            sender = self._running.get(command)
            if sender is None:
                continue
            if result != Ack.IN_PROGRESS:
                del self._running[command]
            elif now_s - self._reported_s < REPORT_S:
                continue
            self._reported_s = now_s
            self._ack(command, result, sender, min(max(percent, 0), 100))
