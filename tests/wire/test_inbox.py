"""Nothing of an `every` topic is lost, of a `latest` topic the newest is kept, and a full inbox holds the sender back."""

from threading import Thread

from wire.inbox import LETTER_BYTES, Inbox
from wire.letter import Kind, Letter


def letter(name: str, seq: int, id: str = "dog-1") -> Letter:
    return Letter(Kind.MESSAGE, name, id, "dog-1", seq=seq)


def test_order_across_topics_is_that_of_arrival() -> None:
    inbox = Inbox(keep_newest_only=True)
    for seq in range(10):
        inbox.put(letter("event", seq))
        inbox.put(letter("odometry", seq))
        inbox.put(letter("odometry", seq, id="dog-2"))
    taken = inbox.take(0.0)
    assert [x.seq for x in taken if x.name == "event"] == list(range(10))
    assert [(x.id, x.seq) for x in taken if x.name == "odometry"] == [("dog-1", 9), ("dog-2", 9)]
    assert [x.name for x in taken[-2:]] == ["odometry", "odometry"]


def test_in_lockstep_everything_is_kept() -> None:
    inbox = Inbox(keep_newest_only=False)
    for seq in range(10):
        inbox.put(letter("odometry", seq))
    assert [x.seq for x in inbox.take(0.0)] == list(range(10))


def test_a_limit_leaves_the_rest_for_later() -> None:
    inbox = Inbox(keep_newest_only=True)
    for seq in range(10):
        inbox.put(letter("event", seq))
    assert [x.seq for x in inbox.take(0.0, limit=4)] == [0, 1, 2, 3]
    assert [x.seq for x in inbox.take(0.0)] == [4, 5, 6, 7, 8, 9]
    assert inbox.take(0.0) == []


def test_a_full_inbox_holds_the_sender_back_and_loses_nothing() -> None:
    inbox = Inbox(keep_newest_only=True, max_bytes=5 * LETTER_BYTES)
    sender = Thread(target=lambda: [inbox.put(letter("event", seq)) for seq in range(1000)])
    sender.start()
    got: list[int] = []
    while len(got) < 1000:
        taken = inbox.take(5.0)
        assert 1 <= len(taken) <= 6
        got += [x.seq for x in taken]
    sender.join()
    assert got == list(range(1000))


def test_closing_lets_a_waiting_sender_go() -> None:
    inbox = Inbox(keep_newest_only=True, max_bytes=0)
    sender = Thread(target=lambda: [inbox.put(letter("event", seq)) for seq in range(3)])
    sender.start()
    inbox.close()
    sender.join(5.0)
    assert not sender.is_alive()
