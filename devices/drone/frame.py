"""The autopilot's local frame (NED, its origin and its north somewhere in the building) and the site's (ENU)."""

from dataclasses import dataclass
from math import degrees, pi, radians

from wire.frames import body_to_enu, enu_to_body, enu_to_ned, ned_to_enu, wrap_rad
from wire.model import Vec3
from wire.site import Robot


@dataclass(frozen=True, slots=True)
class LocalFrame:
    """`north_rad`: the yaw in the site of what the autopilot takes for north."""

    origin_enu_m: Vec3 = (0.0, 0.0, 0.0)
    north_rad: float = pi / 2.0

    @property
    def _turn_rad(self) -> float:
        return self.north_rad - pi / 2.0

    def point(self, ned_m: Vec3) -> Vec3:
        """A local position in the site."""
        return body_to_enu(ned_to_enu(ned_m), self.origin_enu_m, self._turn_rad)

    def local(self, enu_m: Vec3) -> Vec3:
        """A place of the site in the local frame."""
        return enu_to_ned(enu_to_body(enu_m, self.origin_enu_m, self._turn_rad))

    def vector(self, ned: Vec3) -> Vec3:
        """A local velocity in the site's axes."""
        return body_to_enu(ned_to_enu(ned), (0.0, 0.0, 0.0), self._turn_rad)

    def local_vector(self, enu: Vec3) -> Vec3:
        return enu_to_ned(enu_to_body(enu, (0.0, 0.0, 0.0), self._turn_rad))

    def yaw_rad(self, heading_deg: float) -> float:
        """A heading, clockwise from the autopilot's north, as a yaw in the site."""
        return wrap_rad(self.north_rad - radians(heading_deg))

    def heading_deg(self, yaw_rad: float) -> float:
        """In [-180, 180)."""
        return degrees(wrap_rad(self.north_rad - yaw_rad))


def frame_of(row: Robot) -> LocalFrame:
    return LocalFrame(row.origin_enu_m, radians(row.north_deg))
