"""When claims of a property are weighed anew: at once where they differ, once a second where they agree."""

from hub.facts import claim, handle, settle
from hub.records import Fact
from hub.trust import Trust


def agreed() -> Fact:
    """Two cameras say that it is open, and that was weighed at 1 s."""
    fact = Fact()
    for source in ("cam-1", "cam-2"):
        claim(fact, source, 0.9, 1.0)
    settle(fact, 1.0, Trust(), frozenset())
    assert fact.value is True
    return fact


def test_somebody_who_joins_is_heard_at_once() -> None:
    fact = agreed()
    claim(fact, "cam-3", 0.1, 1.1)
    settle(fact, 1.1, Trust(), frozenset())
    assert fact.contradicted_by == ("cam-3",)


def test_somebody_who_changes_his_mind_is_heard_at_once() -> None:
    fact = agreed()
    for _ in range(4):
        claim(fact, "cam-2", 0.0, 1.1)
    settle(fact, 1.1, Trust(), frozenset())
    assert fact.contradicted_by == ("cam-2",)


def test_a_hand_is_heard_at_once_even_if_it_had_said_so_before() -> None:
    fact = agreed()
    handle(fact, "cam-1", True, 1.1)
    assert settle(fact, 1.1, Trust(), frozenset())
    assert fact.source == "cam-1"


def test_who_goes_on_saying_the_same_keeps_it_fresh() -> None:
    fact = agreed()
    claim(fact, fact.source, 0.9, 1.2)
    assert not settle(fact, 1.2, Trust(), frozenset())
    assert fact.stamp_s == 1.2
