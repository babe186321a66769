"""The tables: every row is sound, and what is written on the page and at the router follows from them."""

from pathlib import Path
from typing import get_args

import pytest

from wire.keys import EVERYONE, PRESENCE_PATH, ROLES, SERVICES, TOPICS, Role, Service, Topic
from wire.model import Message
from wire.paths import id_in, key, pattern
from wire.protocol_page import page

ROWS = [*TOPICS, *SERVICES]
PAGE = Path(__file__).parents[2] / "docs" / "protocol.md"


def test_the_page_is_current() -> None:
    assert PAGE.read_text() == page(), "run `python -m wire.protocol_page docs/protocol.md`"


def test_names_and_paths_are_unique() -> None:
    assert len({row.name for row in ROWS}) == len(ROWS)
    assert len({row.path for row in ROWS} | {PRESENCE_PATH}) == len(ROWS) + 1


def test_the_roles_are_those_of_the_type() -> None:
    assert get_args(Role) == ROLES == EVERYONE


@pytest.mark.parametrize("topic", TOPICS, ids=lambda row: row.name)
def test_topic(topic: Topic) -> None:
    assert issubclass(topic.message, Message)
    assert 0.0 <= topic.rate_hz <= 50.0
    assert topic.publishers
    assert topic.subscribers
    assert {*topic.publishers, *topic.subscribers} <= set(ROLES)
    assert topic.about


@pytest.mark.parametrize("service", SERVICES, ids=lambda row: row.name)
def test_service(service: Service) -> None:
    assert issubclass(service.request, Message)
    assert issubclass(service.reply, Message)
    assert 0.0 < service.timeout_s <= 120.0
    assert {*service.servers, *service.callers} <= set(ROLES)
    assert len(service.servers) == 1 or "{id}" in service.path, "one request, one server"


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.name)
def test_key_and_back(row: Topic | Service) -> None:
    id = "dog-1" if "{id}" in row.path else ""
    full = key("r2x", row.path, id)
    assert full.startswith("r2x/")
    assert not set(full) & set("*$#?{}@")
    assert id_in("r2x", row.path, full) == id
    others = [other for other in ROWS if other is not row and id_in("r2x", other.path, full) is not None]
    assert others == [], "a key belongs to one row"


@pytest.mark.parametrize(
    "bad", ["r2x/event/*", "r2x/event/a/b", "r2x/event/", "r2x/event/A", "other/event/a", "r2x/**"]
)
def test_a_key_that_no_node_would_use_has_no_id(bad: str) -> None:
    assert id_in("r2x", "event/{id}", bad) is None


def test_ground_truth_is_for_the_evaluator_alone() -> None:
    truths = [row for row in ROWS if row.path.startswith("gt/")]
    assert len(truths) >= 2
    for row in truths:
        speakers, hearers = (row.publishers, row.subscribers) if isinstance(row, Topic) else (row.servers, row.callers)
        assert (speakers, hearers) == (("sim",), ("evaluator",))


def test_patterns() -> None:
    assert pattern("r2x", "event/{id}", None) == "r2x/event/*"
    assert pattern("r2x", "event/{id}", "hub") == "r2x/event/hub"
    assert pattern("r2x", "clock/tick", None) == "r2x/clock/tick"
    with pytest.raises(ValueError, match="an id is needed"):
        key("r2x", "event/{id}", "")
    with pytest.raises(ValueError, match="takes no id"):
        key("r2x", "clock/tick", "sim")
