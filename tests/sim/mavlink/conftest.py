"""One bed a test, on both firmwares."""

from collections.abc import Iterator

import pytest

from tests.sim.mavlink.bed import Bed


@pytest.fixture(params=["ardupilot", "px4"])
def bed(request) -> Iterator[Bed]:
    made = Bed(request.param)
    yield made
    made.close()
