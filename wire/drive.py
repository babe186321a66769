"""Three ways to step a core: by the wall clock, as a follower of somebody's ticks, and as the owner of the ticks."""

import logging
import time
from collections.abc import Callable, Iterable, Mapping

from wire.bus import Core, Event, Received
from wire.clock import Pace, Roll, WallClock, boot_id, next_turn
from wire.codec import WireError, decode
from wire.letter import Kind, Letter
from wire.messages.clock import Tick, TickDone
from wire.node import ZenohNode
from wire.pulse import Pulse

log = logging.getLogger("clock")

Stopping = Callable[[], bool]
WAIT_S = 0.2
"""How long a signal to stop may go unnoticed before the first tick and between two."""
GATHER_S = 30.0
"""How long the first tick waits for processes that should be there."""
HANG_S = 5.0


def drive_wall(node: ZenohNode, core: Core, pulse: Pulse, stopping: Stopping, step_s: float) -> None:
    """Step every `step_s`, and at once when something comes."""
    clock = WallClock()
    node.boot_id = boot_id(clock.now_s())
    core.start(node)
    node.announce()
    while not stopping():
        events = node.collect(step_s)
        core.step(clock.now_s(), events)
        pulse.beat(clock.now_s())


def drive_spectator(node: ZenohNode, core: Core, pulse: Pulse, stopping: Stopping, step_s: float) -> None:
    """Look on in lockstep without holding time up: events as they come, at the time of the newest tick."""
    now_s = 0.0
    node.boot_id = boot_id(WallClock().now_s())  # it may step before it has heard of a tick
    node.subscribe("tick")
    core.start(node)
    node.announce()
    while not stopping():
        events: list[Event] = []
        for event in node.collect(step_s):
            if isinstance(event, Received) and isinstance(event.message, Tick):
                now_s = event.message.now_s
            else:
                events.append(event)
        core.step(now_s, events)
        pulse.beat(now_s)


def drive_follower(node: ZenohNode, core: Core, pulse: Pulse, stopping: Stopping) -> None:
    """One step per turn, then say that it is done, and until when nothing is to be done."""
    node.subscribe("turn", node.id)
    core.start(node)
    node.announce()
    while not stopping():
        tick = _newest_tick(node, node.shelf.wait())
        if tick is None:
            continue
        _pick_up(node)
        node.tick, node.now_s = tick.tick, tick.now_s
        node.boot_id = node.boot_id or boot_id(tick.now_s)
        core.step(tick.now_s, node.mailbox.at_tick(tick.tick, tick.now_s))
        pulse.beat(tick.now_s)
        turn = next_turn(core, pulse.due_s, tick.tick, tick.now_s, tick.step_s)
        wakes = node.outbox.take_wakes()
        done = TickDone(tick=tick.tick, follower=node.id, next_turn=turn, wakes=wakes)
        node.publish("tick_done", done, node.id)


def drive_owner(
    node: ZenohNode, core: Core, pulse: Pulse, stopping: Stopping, step_s: float, speed: float, roles: Mapping[str, str]
) -> None:
    """Step, tell the tick, and wait until every follower whose turn it is has stepped, too. `roles`: of the followers."""
    roll, pace = Roll(roles), Pace(speed)
    node.subscribe("tick_done")
    node.track_presence()
    core.start(node)
    node.announce()
    _gather(node, roll, stopping)
    tick = 0
    node.boot_id = boot_id(0.0)
    while not stopping():
        node.tick, node.now_s = tick, tick * step_s
        core.step(node.now_s, node.mailbox.at_tick(tick, node.now_s))
        pulse.beat(node.now_s)
        news = Tick(tick=tick, now_s=node.now_s, step_s=step_s)
        node.publish("tick", news)
        for follower in roll.begin(tick):
            node.publish("turn", news, follower)
        _wait_for(node, roll, stopping)
        tick += 1
        _keep_pace(node, roll, pace, tick * step_s)


def _pick_up(node: ZenohNode, timeout_s: float = 0.0) -> list[Letter]:
    """Hold all post until it is due. What came of presence is returned, too."""
    letters = node.inbox.take(timeout_s)
    presence = [letter for letter in letters if letter.kind is Kind.PRESENCE]
    node.mailbox.hold(letter for letter in letters if node.watching or letter.kind is not Kind.PRESENCE)
    node.mailbox.hold(node.shelf.fetch())
    return presence


def _note_done(node: ZenohNode, roll: Roll, answer: Letter) -> None:
    """Whoever answers in a way that is not understood is asked in every tick."""
    try:
        done = decode(TickDone, answer.payload, answer.name)
    except WireError as error:
        node.mailbox.warn(str(error))
        roll.done(answer.id, answer.tick)
        return
    roll.done(answer.id, answer.tick, done.next_turn, done.wakes)


def _newest_tick(node: ZenohNode, letters: Iterable[Letter]) -> Tick | None:
    """A follower that was away skips the ticks that went on without it."""
    newest = None
    for letter in letters:
        try:
            newest = decode(Tick, letter.payload, letter.name)
        except WireError as error:
            node.mailbox.warn(str(error))
    return newest


def _call_roll(node: ZenohNode, roll: Roll, timeout_s: float = 0.0) -> None:
    for letter in _pick_up(node, timeout_s):
        roll.presence(letter.id, letter.alive)


def _gather(node: ZenohNode, roll: Roll, stopping: Stopping) -> None:
    """Before the first tick: everybody hears it, whoever starts first."""
    began_s = counted_s = time.monotonic()
    while roll.absent and not stopping():
        _call_roll(node, roll, WAIT_S)
        counted_s = _recount(node, counted_s)
        if time.monotonic() - began_s > GATHER_S:
            log.warning("starting without %s: not there after %.0f s", ", ".join(roll.absent), GATHER_S)
            return


def _recount(node: ZenohNode, counted_s: float) -> float:
    """While somebody is missed: ask now and then who is there. Returns when that was done last."""
    now_s = time.monotonic()
    if now_s - counted_s < HANG_S:
        return counted_s
    node.recount()
    return now_s


def _wait_for(node: ZenohNode, roll: Roll, stopping: Stopping) -> None:
    began_s = counted_s = time.monotonic()
    warned = False
    while (roll.waiting or roll.deserted) and not stopping():
        answers = node.shelf.wait()
        for letter in answers:
            _note_done(node, roll, letter)
        if answers:
            continue
        _call_roll(node, roll)
        counted_s = _recount(node, counted_s)
        if not warned and time.monotonic() - began_s > HANG_S:
            warned = True
            whom = ", ".join(roll.waiting) or "any follower to come back"
            log.warning("time stands still: waiting for %s since %.0f s", whom, HANG_S)
    _call_roll(node, roll)


def _keep_pace(node: ZenohNode, roll: Roll, pace: Pace, now_s: float) -> None:
    while (ahead_s := pace.ahead_s(now_s, time.monotonic())) > 1e-4:
        _call_roll(node, roll, min(ahead_s, WAIT_S))
