"""Between degrees and local NED: the plane that touches the globe at the origin, as flight controllers have it."""

import math
from dataclasses import dataclass

from sim.flight.state import Vec3

EARTH_RADIUS_M = 6371000.0
LOCAL_FRAMES = frozenset({1, 7, 8, 9, 12})
"""MAV_FRAME: LOCAL_NED, LOCAL_OFFSET_NED, BODY_NED, BODY_OFFSET_NED, BODY_FRD."""
SEA_LEVEL_FRAMES = frozenset({0, 5})
"""GLOBAL and GLOBAL_INT: altitude above mean sea level."""
HOME_FRAMES = frozenset({3, 6})
"""GLOBAL_RELATIVE_ALT and its INT: altitude above home."""
FLOOR_FRAMES = frozenset({10, 11})
"""GLOBAL_TERRAIN_ALT and its INT: altitude above the floor."""
GLOBAL_FRAMES = SEA_LEVEL_FRAMES | HOME_FRAMES | FLOOR_FRAMES
FARTHEST_M = 2000.0
"""Nothing farther than this from the origin is taken for a place that somebody meant."""


@dataclass(frozen=True, slots=True)
class Origin:
    """Where local NED's origin lies on the globe."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float
    """Above mean sea level."""

    def valid(self) -> bool:
        """Whether it is a place on Earth that local coordinates can be laid at."""
        numbers = (self.latitude_deg, self.longitude_deg, self.altitude_m)
        return (
            all(map(math.isfinite, numbers))
            and abs(self.latitude_deg) < 89.9
            and abs(self.longitude_deg) <= 180.0
            and abs(self.altitude_m) < 10000.0
        )

    def local(self, latitude_deg: float, longitude_deg: float) -> tuple[float, float]:
        """(north, east) in metres of a point given in degrees."""
        east_deg = (longitude_deg - self.longitude_deg + 180.0) % 360.0 - 180.0
        north = math.radians(latitude_deg - self.latitude_deg) * EARTH_RADIUS_M
        return north, math.radians(east_deg) * EARTH_RADIUS_M * math.cos(math.radians(self.latitude_deg))

    def globe(self, north_m: float, east_m: float) -> tuple[float, float]:
        """(latitude, longitude) in degrees of a local point."""
        latitude = self.latitude_deg + math.degrees(north_m / EARTH_RADIUS_M)
        per_radian = EARTH_RADIUS_M * math.cos(math.radians(self.latitude_deg))
        longitude = self.longitude_deg + math.degrees(east_m / per_radian)
        return latitude, (longitude + 180.0) % 360.0 - 180.0


def place(
    frame: int, x: float, y: float, z: float, origin: Origin | None, home: Vec3 | None, here: Vec3
) -> Vec3 | str | None:
    """Local NED of a point in a global frame or LOCAL_NED. NaN in x and y or in z means where it is now.

    A sentence when the numbers make no sense; None when the frame is not one that gives a place.
    """
    if frame in GLOBAL_FRAMES:
        return _from_globe(frame, (x, y, z), origin, home, here)
    if frame != 1:
        return None
    north, east = (here[0], here[1]) if math.isnan(x) or math.isnan(y) else (x, y)
    return _sensible((north, east, here[2] if math.isnan(z) else z))


def _from_globe(
    frame: int, point: tuple[float, float, float], origin: Origin | None, home: Vec3 | None, here: Vec3
) -> Vec3 | str:
    latitude, longitude, altitude = point
    if origin is None:
        return "No global origin is set: send SET_GPS_GLOBAL_ORIGIN first, or use a local frame."
    if math.isnan(latitude) or math.isnan(longitude):
        north, east = here[0], here[1]
    elif not (abs(latitude) <= 90.0 and abs(longitude) <= 180.0):
        return f"{latitude:g}, {longitude:g} is no place on Earth."
    else:
        north, east = origin.local(latitude, longitude)
    if math.isnan(altitude):
        down = here[2]
    elif frame in SEA_LEVEL_FRAMES:
        down = origin.altitude_m - altitude
    elif frame in HOME_FRAMES:
        down = (home[2] if home else 0.0) - altitude
    else:
        down = -altitude
    return _sensible((north, east, down))


def _sensible(point: Vec3) -> Vec3 | str:
    if not all(math.isfinite(axis) for axis in point):
        return "The position is not finite."
    if max(abs(axis) for axis in point) > FARTHEST_M:
        return f"The position is more than {FARTHEST_M:.0f} m away."
    return point
