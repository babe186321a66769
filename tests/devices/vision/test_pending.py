"""Results come at their time, in order, whether the work was quick or not."""

import threading

import pytest

from devices.vision.pending import Pending
from devices.vision.picture import PictureError


def test_results_are_handed_out_when_they_are_due_and_not_before() -> None:
    pending: Pending[int] = Pending("test", takes_s=0.15)
    pending.begin(1.0, lambda: 1)
    pending.begin(1.1, lambda: 2)
    assert pending.due(1.1) == []
    assert pending.due(1.15) == [1]
    assert pending.due(1.3) == [2]
    assert pending.due(9.0) == []
    pending.close()


def test_late_work_is_waited_for() -> None:
    pending: Pending[str] = Pending("test", takes_s=0.1)
    may_end = threading.Event()
    pending.begin(0.0, lambda: str(may_end.wait(10.0)))
    threading.Timer(0.05, may_end.set).start()
    assert pending.due(0.1) == ["True"]
    pending.close()


def test_what_the_work_raises_is_raised_where_it_is_due() -> None:
    pending: Pending[None] = Pending("test", takes_s=0.1)

    def fail() -> None:
        raise PictureError("no picture")

    pending.begin(0.0, fail)
    with pytest.raises(PictureError, match="no picture"):
        pending.due(0.1)
    pending.close()
