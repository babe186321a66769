"""Rigs for the tests of the autopilot: one vehicle of either firmware."""

import pytest

from tests.sim.autopilot.rig import Rig


@pytest.fixture
def rigs():
    """Makes rigs and closes them."""
    made = []

    def make(*args, **kwargs) -> Rig:
        made.append(Rig(*args, **kwargs))
        return made[-1]

    yield make
    for rig in made:
        rig.close()


@pytest.fixture(params=["ardupilot", "px4"])
def rig(request, rigs) -> Rig:
    return rigs(request.param)
