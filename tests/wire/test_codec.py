"""Every message survives the wire unchanged, and nothing else gets through."""

import math
import tracemalloc
from typing import Any

import msgpack
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.wire.messages import message_types, messages
from wire.codec import WireError, decode, encode, max_bytes
from wire.messages.clock import Health, TickDone
from wire.messages.goal import Selector
from wire.messages.observation import ObservationBatch
from wire.messages.world import WorldState
from wire.model import Message

DONE = {"tick": 1, "follower": "hub"}


@pytest.mark.parametrize("message_type", message_types(), ids=lambda t: t.__name__)
@settings(max_examples=12, deadline=None, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_round_trip(message_type: type[Message], data: st.DataObject) -> None:
    message = data.draw(messages(message_type))
    assert decode(message_type, encode(message)) == message


def refused(message_type: type[Message], payload: bytes) -> str:
    with pytest.raises(WireError) as caught:
        decode(message_type, payload, "some/key")
    text = str(caught.value)
    assert text.startswith("some/key: ")
    assert "\n" not in text
    assert len(text) < 1000
    return text


def test_100_mb_of_nesting() -> None:
    assert "too many" in refused(TickDone, b"\x91" * 100_000_000)


@pytest.mark.parametrize("head", [b"\x91", b"\x81\xa1a"])
def test_deep_nesting_within_the_size(head: bytes) -> None:
    assert "nested too deeply" in refused(TickDone, head * 90_000)


def test_a_megabyte_of_empty_maps_costs_no_memory() -> None:
    bomb = b"\xdd" + (1_000_000).to_bytes(4, "big") + b"\x80" * 1_000_000
    tracemalloc.start()
    assert "max_array_len" in refused(WorldState, bomb)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 10_000_000


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"tick": 1.5}, "tick: input should be a valid integer"),
        ({"tick": "1"}, "tick: input should be a valid integer"),
        ({"tick": True}, "tick: input should be a valid integer"),
        ({"follower": "a/*"}, "follower: an id: at most 32 lower-case letters, digits and hyphens is expected"),
        ({"follower": b"hub"}, "follower: input should be a valid string"),
        ({"colour": "red"}, "colour: unknown field, leave it out; TickDone has tick, follower"),
    ],
)
def test_a_wrong_field_is_named(change: dict[str, Any], named: str) -> None:
    assert named in refused(TickDone, msgpack.packb({**DONE, **change}))


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_only_finite_numbers(value: float) -> None:
    health = {"process": "hub", "boot_id": "b", "seq": 0, "stamp_s": value, "loop_age_ms": 0.0, "mode": "ready"}
    assert "stamp_s: input should be a finite number" in refused(Health, msgpack.packb(health))


def test_a_deep_path_is_cut_short() -> None:
    nested: dict[str, Any] = {"type": "Mug", "colour": "red"}
    for _ in range(100):
        nested = {"type": "Mug", "exclude": [nested]}
    assert "exclude.0.exclude.0..." in refused(Selector, msgpack.packb(nested))


@given(cut=st.integers(min_value=0, max_value=len(msgpack.packb(DONE)) - 1))
def test_truncated_bytes(cut: int) -> None:
    assert "TickDone is expected" in refused(TickDone, msgpack.packb(DONE)[:cut])


@given(payload=st.binary(max_size=200))
def test_any_bytes_are_a_message_or_a_wire_error(payload: bytes) -> None:
    for message_type in (ObservationBatch, TickDone, Selector):
        try:
            assert isinstance(decode(message_type, payload), message_type)
        except WireError:
            continue


def test_what_is_too_big_is_not_sent() -> None:
    from wire.messages.operator import TaskRequest

    huge = TaskRequest.model_construct(task="t", instruction="x" * max_bytes(TaskRequest))
    with pytest.raises(WireError, match="too many"):
        encode(huge)
