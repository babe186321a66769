"""In lockstep only the clock's messages end the wait; what came before them is there to be fetched."""

from collections.abc import Iterator
from typing import Any

import pytest
import zenoh

from wire.letter import Kind, Letter
from wire.node import open_session
from wire.shelf import Shelf

ALONE = {
    "mode": "peer",
    "listen": {"endpoints": []},
    "scouting": {"multicast": {"enabled": False}, "gossip": {"enabled": False}},
}


def open_sample(sample: Any) -> Letter | None:
    payload = sample.payload.to_bytes()
    return Letter(Kind.MESSAGE, str(sample.key_expr), "", payload=payload) if payload else None


@pytest.fixture
def session() -> Iterator[zenoh.Session]:
    with open_session(ALONE) as session:
        yield session


@pytest.fixture
def shelf(session: zenoh.Session) -> Iterator[Shelf]:
    shelf = Shelf(lambda: session.put("clock", b""))
    box: Any = zenoh.handlers.FifoChannel(1000)
    shelf.add(session.declare_subscriber("scan/*", box), open_sample)
    shelf.add_clock(session.declare_subscriber("clock", box), open_sample)
    yield shelf
    shelf.close()


def test_what_was_sent_before_the_clock_is_there_when_the_clock_is(session: zenoh.Session, shelf: Shelf) -> None:
    for number in range(50):
        session.put(f"scan/{number}", b"s")
    session.put("clock", b"1")
    session.put("clock", b"2")
    clock: list[Letter] = []
    while len(clock) < 2:
        clock += shelf.wait()
    assert [letter.payload for letter in clock] == [b"1", b"2"]
    assert [letter.name for letter in shelf.fetch()] == [f"scan/{number}" for number in range(50)]
    assert shelf.fetch() == []


def test_a_loop_without_a_clock_is_nudged(shelf: Shelf) -> None:
    assert shelf.wait() == []
    assert shelf.wait() == []
