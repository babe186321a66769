"""What MAVSDK shows of a vehicle, bit by bit, and what is made of it."""

import asyncio

import pytest
from mavsdk.asyncio import Autopilot
from mavsdk.asyncio import Vehicle as VehicleType

from devices.drone import identity


class Shown:
    """A system that MAVSDK shows before it has read its heartbeat. `autopilot`, `kind`: after how many questions."""

    def __init__(self, autopilot: float, kind: float) -> None:
        self._autopilot, self._kind = autopilot, kind

    async def autopilot_type(self) -> Autopilot:
        self._autopilot -= 1
        return Autopilot.UNKNOWN if self._autopilot >= 0 else Autopilot.PX4

    async def vehicle_type(self) -> VehicleType:
        self._kind -= 1
        return VehicleType.GENERIC if self._kind >= 0 else VehicleType.MULTICOPTER


@pytest.mark.parametrize("shown", [Shown(0, 0), Shown(1, 1), Shown(0, 1), Shown(0, 5), Shown(4, 4)])
def test_it_is_known_by_its_heartbeat_however_late(shown: Shown) -> None:
    assert asyncio.run(identity.identify(shown)) == ("px4", VehicleType.MULTICOPTER)


def test_one_of_no_known_family_is_one_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(identity, "PATIENCE_S", 0.1)
    never = float("inf")
    assert asyncio.run(identity.identify(Shown(never, 0))) == ("unknown", VehicleType.MULTICOPTER)
    assert asyncio.run(identity.identify(Shown(never, never))) == ("unknown", VehicleType.GENERIC)
