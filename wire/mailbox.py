"""Letters in, events out: what a node does with its post, the same over Zenoh and in memory.

In lockstep a letter is handed out at tick n when its sender sent it before tick n, or in tick n if the sender owns the
clock; letters without a tick go out with the next one. The events of one tick are sorted, so that every run sees the
same. Times are seconds on the mesh's clock.
"""

import logging
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

from wire.bus import Event, Presence, Received, Reply, Request
from wire.codec import WireError, decode, encode
from wire.keys import SERVICE, TOPIC
from wire.letter import NO_TICK, Kind, Letter
from wire.model import Message

log = logging.getLogger("wire")


@dataclass(frozen=True)
class _Question:
    service: str
    id: str
    asked_s: float
    timeout_s: float


class Mailbox:
    """The post of one process. `owner` is the process that owns the clock."""

    def __init__(self, process: str, owner: str = "") -> None:
        self._process = process
        self._owner = owner
        self._held: list[Letter] = []
        self._questions: dict[int, _Question] = {}
        self._asked = 0
        self._last_tick = NO_TICK
        self.malformed = 0
        """Letters that could not be understood."""

    def ask(self, service: str, id: str, now_s: float, timeout_s: float | None) -> int:
        """Note an open question and return its number."""
        self._asked += 1
        timeout_s = SERVICE[service].timeout_s if timeout_s is None else timeout_s
        self._questions[self._asked] = _Question(service, id, now_s, timeout_s)
        return self._asked

    def hold(self, letters: Iterable[Letter]) -> None:
        """Keep letters for the tick in which they are due."""
        self._held.extend(letters)

    def at_tick(self, tick: int, now_s: float) -> list[Event]:
        """The events of one tick in lockstep."""
        if tick < self._last_tick:
            self._held.clear()  # the owner of the clock began anew: what was held belongs to a time that is gone
        self._last_tick = tick
        due = sorted((letter for letter in self._held if self._is_due(letter, tick)), key=_order)
        self._held = [letter for letter in self._held if not self._is_due(letter, tick)]
        return self.open(_newest(due), now_s)

    def open(self, letters: Iterable[Letter], now_s: float) -> list[Event]:
        """The events in these letters, in their order, then the questions that nobody answered in time."""
        events = [event for letter in letters if (event := self._event(letter)) is not None]
        return events + self._unanswered(now_s)

    def _is_due(self, letter: Letter, tick: int) -> bool:
        return letter.tick < tick or (letter.tick == tick and letter.sender == self._owner)

    def _event(self, letter: Letter) -> Event | None:
        if letter.kind is Kind.REPLY:
            return self._reply(letter)
        if letter.kind is Kind.PRESENCE:
            return None if letter.id == self._process else Presence(letter.id, letter.alive)
        try:
            if letter.kind is Kind.MESSAGE:
                message = decode(TOPIC[letter.name].message, letter.payload, _place(letter))
                return Received(letter.name, letter.id, message)
            return self._request(letter)
        except WireError as error:
            self.warn(f"{error} (from {letter.sender or 'unknown'})")
            if letter.refuse is not None:
                letter.refuse(str(error))
            return None

    def _request(self, letter: Letter) -> Request:
        service = SERVICE[letter.name]
        question = decode(service.request, letter.payload, _place(letter))
        answer = letter.answer

        def reply(message: Message) -> None:
            nonlocal answer
            if not isinstance(message, service.reply):
                raise TypeError(f"{service.name} is answered by {service.reply.__name__}, not {type(message).__name__}")
            if answer is None:
                raise RuntimeError(f"this request to {service.name} has its answer already")
            send, answer = answer, None
            send(encode(message))

        return Request(letter.name, letter.id, question, reply)

    def _reply(self, letter: Letter) -> Reply | None:
        question = self._questions.pop(letter.ask, None)
        if question is None:
            return None
        if letter.error:
            return Reply(letter.ask, question.service, question.id, None, letter.error)
        try:
            message = decode(SERVICE[question.service].reply, letter.payload, _place(letter))
        except WireError as error:
            self.warn(str(error))
            return Reply(letter.ask, question.service, question.id, None, str(error))
        return Reply(letter.ask, question.service, question.id, message)

    def _unanswered(self, now_s: float) -> list[Event]:
        # a ten-thousandth of a second of grace for sums of steps that binary fractions cannot hold
        late = [n for n, q in self._questions.items() if now_s >= q.asked_s + q.timeout_s - 1e-4]
        gone = [(number, self._questions.pop(number)) for number in late]
        return [Reply(n, q.service, q.id, None, f"no answer from {_name(q)} in {q.timeout_s:g} s") for n, q in gone]

    def warn(self, text: str) -> None:
        """Log the 1st, 2nd, 4th, 8th ... fault: a flood of them must not become a flood of lines."""
        self.malformed += 1
        if self.malformed & (self.malformed - 1) == 0:
            log.warning("refused message number %d: %s", self.malformed, text)


def _order(letter: Letter) -> tuple[int, str, str, str, int, int]:
    return (letter.kind, letter.name, letter.id, letter.sender, letter.tick, letter.seq)


def _newest(letters: list[Letter]) -> list[Letter]:
    """Without the letters that a newer one of the same `latest` topic and sender follows."""
    kept = [letter for letter, next_ in pairwise(letters) if not _replaces(letter, next_)]
    return kept + letters[-1:]


def _replaces(old: Letter, new: Letter) -> bool:
    if old.kind is not Kind.MESSAGE or new.kind is not Kind.MESSAGE or TOPIC[old.name].delivery != "latest":
        return False
    return (old.name, old.id, old.sender) == (new.name, new.id, new.sender)


def _place(letter: Letter) -> str:
    return f"{letter.name}/{letter.id}" if letter.id else letter.name


def _name(question: _Question) -> str:
    return f"{question.service}/{question.id}" if question.id else question.service
