import asyncio

import pytest
from mavsdk.asyncio import Autopilot
from mavsdk.asyncio import Vehicle as VehicleType

from devices.drone import identity


class Shown:
    """A system that MAVSDK shows before it has read its heartbeat. `looks`: how often it is asked until then."""

    def __init__(self, looks: float, autopilot: Autopilot, kind: VehicleType) -> None:
        self._looks, self._autopilot, self._kind = looks, autopilot, kind

    async def autopilot_type(self) -> Autopilot:
        self._looks -= 1
        return Autopilot.UNKNOWN if self._looks >= 0 else self._autopilot

    async def vehicle_type(self) -> VehicleType:
        return VehicleType.GENERIC if self._looks >= 0 else self._kind


@pytest.mark.parametrize("looks", [0, 1, 5])
def test_it_is_known_by_its_heartbeat_however_late(looks: int) -> None:
    shown = Shown(looks, Autopilot.PX4, VehicleType.MULTICOPTER)
    assert asyncio.run(identity.identify(shown)) == ("px4", VehicleType.MULTICOPTER)


def test_one_of_no_known_family_is_one_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(identity, "PATIENCE_S", 0.1)
    shown = Shown(float("inf"), Autopilot.ARDUPILOT, VehicleType.MULTICOPTER)
    assert asyncio.run(identity.identify(shown)) == ("unknown", VehicleType.GENERIC)
