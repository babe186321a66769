"""What is handed out at a tick does not depend on when it arrived."""

import logging

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.wire.cores import describe
from wire.bus import Presence, Reply
from wire.codec import encode
from wire.letter import NO_TICK, Kind, Letter, read_stamp, write_stamp
from wire.mailbox import Mailbox
from wire.messages.observation import EventLog


def said(sender: str, tick: int, seq: int) -> Letter:
    line = EventLog(source="hub", seq=seq, stamp_s=0.0, text=f"{sender} in tick {tick}")
    return Letter(Kind.MESSAGE, "event", sender, sender, tick, seq, encode(line))


LETTERS = [said(sender, tick, seq) for sender in ("dog-1", "dog-2", "sim") for tick in range(4) for seq in (1, 2)]


def handed_out(arrivals: list[list[Letter]]) -> list[list[str]]:
    mailbox = Mailbox("hub", owner="sim")
    days = []
    for tick, letters in enumerate(arrivals):
        mailbox.hold(letters)
        days.append([describe(event) for event in mailbox.at_tick(tick, tick * 0.05)])
    return days


@given(st.data())
def test_the_same_whenever_it_arrived(data: st.DataObject) -> None:
    arrivals: list[list[Letter]] = [[] for _ in range(6)]
    for letter in data.draw(st.permutations(LETTERS)):
        # a letter arrives at any moment before the tick at which it is due
        due = letter.tick if letter.sender == "sim" else letter.tick + 1
        arrivals[data.draw(st.integers(0, due))].append(letter)
    assert handed_out(arrivals) == handed_out([LETTERS, [], [], [], [], []])


def test_the_owner_is_heard_in_the_same_tick_and_others_in_the_next() -> None:
    days = handed_out([[said("sim", 0, 1), said("dog-1", 0, 1)], []])
    assert ["sim in tick 0" in text for text in days[0]] == [True]
    assert ["dog-1 in tick 0" in text for text in days[1]] == [True]


def test_senders_outside_lockstep_are_heard_with_the_next_tick() -> None:
    assert len(handed_out([[said("console-1", NO_TICK, 1)]])[0]) == 1


def test_when_the_clock_begins_anew_what_was_held_is_forgotten() -> None:
    mailbox = Mailbox("hub", owner="sim")
    mailbox.at_tick(100, 5.0)
    mailbox.hold([said("dog-1", 100, 1)])
    assert mailbox.at_tick(0, 0.0) == []
    assert mailbox.at_tick(101, 5.05) == []


def test_malformed_letters_are_counted_and_not_all_logged(caplog: pytest.LogCaptureFixture) -> None:
    mailbox = Mailbox("hub")
    refusals: list[str] = []
    with caplog.at_level(logging.WARNING):
        for _ in range(100):
            assert mailbox.open([Letter(Kind.MESSAGE, "event", "dog-1", "dog-1", payload=b"\xc1")], 0.0) == []
        bad_request = Letter(Kind.REQUEST, "task", "", "console-1", payload=b"\x80", refuse=refusals.append)
        assert mailbox.open([bad_request], 0.0) == []
    assert mailbox.malformed == 101
    assert len(caplog.records) == 7
    assert "event/dog-1: not valid msgpack" in caplog.text
    assert refusals == ["task: task: is missing; instruction: is missing"]


def test_a_reply_is_handed_out_once_and_not_after_its_time() -> None:
    mailbox = Mailbox("hub")
    first, second = mailbox.ask("card", "dog-1", 0.0, 1.0), mailbox.ask("card", "dog-2", 0.0, None)
    answer = Letter(Kind.REPLY, "card", "dog-1", ask=first, error="no")
    assert mailbox.open([answer, answer], 0.5) == [Reply(first, "card", "dog-1", None, "no")]
    assert mailbox.open([], 0.9) == []
    assert mailbox.open([], 1.0) == [Reply(second, "card", "dog-2", None, "no answer from card/dog-2 in 1 s")]
    assert mailbox.open([Letter(Kind.REPLY, "card", "dog-2", ask=second, error="late")], 1.1) == []


def test_a_process_does_not_watch_itself() -> None:
    mailbox = Mailbox("hub")
    letters = [Letter(Kind.PRESENCE, "", id, alive=True) for id in ("hub", "sim")]
    assert mailbox.open(letters, 0.0) == [Presence("sim", True)]


@given(st.integers(NO_TICK, 2**40), st.integers(0, 2**40), st.from_regex(r"[a-z0-9][a-z0-9-]{0,31}", fullmatch=True))
def test_stamp_and_back(tick: int, seq: int, sender: str) -> None:
    assert read_stamp(write_stamp(tick, seq, sender)) == (tick, seq, sender)


@pytest.mark.parametrize("bad", [b"", b"x" * 16, b"x" * 49, b"x" * 16 + b"\xff"])
def test_what_is_no_stamp(bad: bytes) -> None:
    with pytest.raises(ValueError):  # noqa: PT011 - UnicodeDecodeError has a text of its own
        read_stamp(bad)
