"""Readings from the true motion: noise, biases that wander, rates of their own. Nothing else may look at the truth."""

import random
from math import atan2, cos, exp, log, sin

from sim.flight.attitude import rotate_back
from sim.flight.state import Quaternion, Sensors, Vec3

GYRO_RADPS, ACCEL_MPS2, MAG_GAUSS, BARO_HPA = 0.004, 0.06, 0.004, 0.012
GYRO_BIAS_RADPS, ACCEL_BIAS_MPS2 = 0.006, 0.04
FIX_M, FIX_MPS = 0.015, 0.04
FIELD_NED_GAUSS: Vec3 = (0.21, 0.01, 0.43)
_TABLE = 8191
"""Normal numbers drawn once; a prime, so that strides through it do not repeat together."""
_SEA_LEVEL_HPA, _SCALE_HEIGHT_M = 1013.25, 8434.0


class SensorModel:
    """Gyroscope and accelerometer at every call of `inertial`; the slow ones at every call of `slow`."""

    __slots__ = (
        "_accel_bias",
        "_altitude_m",
        "_at",
        "_gyro_bias",
        "_mag_bias",
        "_noise",
        "_random",
        "fixes",
        "readings",
    )

    def __init__(self, seed: int, fixes: bool, altitude_m: float) -> None:
        self._random = rng = random.Random(seed)
        self._noise = [rng.gauss(0.0, 1.0) for _ in range(_TABLE)]
        self._at = 0
        self._gyro_bias = [rng.gauss(0.0, GYRO_BIAS_RADPS) for _ in range(3)]
        self._accel_bias = [rng.gauss(0.0, ACCEL_BIAS_MPS2) for _ in range(3)]
        self._mag_bias = [rng.gauss(0.0, MAG_GAUSS) for _ in range(3)]
        self._altitude_m = altitude_m
        self.fixes = fixes
        """Whether there is an indoor position system."""
        names = ("gyro", "accel", "mag", "baro", "fix", "battery")
        self.readings = Sensors(healthy={name: fixes if name == "fix" else True for name in names})

    def inertial(self, rates_frd_radps: Vec3, force_frd_mps2: Vec3) -> None:
        """`force_frd_mps2`: specific force, what an accelerometer measures."""
        noise, at, gyro, accel = self._noise, self._at, self._gyro_bias, self._accel_bias
        self._at = (at + 6) % (_TABLE - 6)
        p, q, r = rates_frd_radps
        a, b, c = force_frd_mps2
        readings = self.readings
        if readings.healthy["gyro"]:
            readings.gyro_frd_radps = (
                p + gyro[0] + GYRO_RADPS * noise[at],
                q + gyro[1] + GYRO_RADPS * noise[at + 1],
                r + gyro[2] + GYRO_RADPS * noise[at + 2],
            )
        if readings.healthy["accel"]:
            readings.accel_frd_mps2 = (
                a + accel[0] + ACCEL_MPS2 * noise[at + 3],
                b + accel[1] + ACCEL_MPS2 * noise[at + 4],
                c + accel[2] + ACCEL_MPS2 * noise[at + 5],
            )

    def slow(self, attitude: Quaternion, position_ned_m: Vec3, velocity_ned_mps: Vec3) -> None:
        """Magnetometer, barometer and, where there is one, the position fix; biases wander a little."""
        gauss, readings, healthy = self._random.gauss, self.readings, self.readings.healthy
        for biases, wander in ((self._gyro_bias, 2e-5), (self._accel_bias, 2e-4)):
            for k in (0, 1, 2):
                biases[k] += wander * gauss(0.0, 1.0)
        if healthy["mag"]:
            x, y, z = rotate_back(attitude, FIELD_NED_GAUSS)
            bx, by, bz = self._mag_bias
            readings.mag_frd_gauss = (
                x + bx + gauss(0.0, MAG_GAUSS),
                y + by + gauss(0.0, MAG_GAUSS),
                z + bz + gauss(0.0, MAG_GAUSS),
            )
        if healthy["baro"]:
            height_m = self._altitude_m - position_ned_m[2]
            readings.pressure_hpa = _SEA_LEVEL_HPA * exp(-height_m / _SCALE_HEIGHT_M) + gauss(0.0, BARO_HPA)
        if self.fixes and healthy["fix"]:
            n, e, d = position_ned_m
            vn, ve, vd = velocity_ned_mps
            readings.fix_ned_m = (n + gauss(0.0, FIX_M), e + gauss(0.0, FIX_M), d + gauss(0.0, FIX_M))
            readings.fix_velocity_ned_mps = (
                vn + gauss(0.0, FIX_MPS),
                ve + gauss(0.0, FIX_MPS),
                vd + gauss(0.0, FIX_MPS),
            )
        else:
            readings.fix_ned_m = None

    def baro_height_m(self) -> float:
        """Above the site's floor, by the pressure."""
        return -_SCALE_HEIGHT_M * log(self.readings.pressure_hpa / _SEA_LEVEL_HPA) - self._altitude_m


def magnetic_heading(mag_frd_gauss: Vec3, roll_rad: float, pitch_rad: float) -> float:
    """Heading of true north from a levelled compass, in radians."""
    x, y, z = mag_frd_gauss
    cr, sr, cp, sp = cos(roll_rad), sin(roll_rad), cos(pitch_rad), sin(pitch_rad)
    level_x = x * cp + y * sr * sp + z * cr * sp
    level_y = y * cr - z * sr
    return atan2(FIELD_NED_GAUSS[1], FIELD_NED_GAUSS[0]) - atan2(level_y, level_x)
