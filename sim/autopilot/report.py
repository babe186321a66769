"""Telemetry of one moment."""

from sim.autopilot import arming
from sim.autopilot.conduct import Conduct
from sim.autopilot.health import estimator_flags, masks
from sim.autopilot.interface import Telemetry
from sim.autopilot.personality import Mode
from sim.autopilot.phase import landing, taking_off

_CUSTOM, _AUTO, _GUIDED, _STABILIZED, _MANUAL, _ARMED = 1, 4, 8, 16, 64, 128
"""MAV_MODE_FLAG."""
_BY_STICKS: frozenset[Mode] = frozenset({"stabilize", "position"})
_SELF_LEVELLED: frozenset[Mode] = frozenset({"stabilize", "land"})
"""ArduCopter's modes that are not called guided."""
_STANDBY, _ACTIVE, _CRITICAL = 3, 4, 5
_ON_GROUND, _IN_AIR, _TAKING_OFF, _LANDING = 1, 2, 3, 4


def report(conduct: Conduct, now_s: float) -> Telemetry:
    now, activity, mission = conduct.now, conduct.activity, conduct.plans.mission
    vehicle = now.vehicle
    watch = conduct.failsafes.watch
    armable = next(arming.reasons(now, watch), None) is None or now.armed
    present, enabled, health = masks(now, conduct.plans.fence, bool(watch.breach), armable)
    landed = _ON_GROUND
    if now.flying:
        landed = _TAKING_OFF if taking_off(activity) else _LANDING if landing(activity) else _IN_AIR
    status = _STANDBY
    if now.armed:
        status = _CRITICAL if conduct.failsafes.critical else _ACTIVE
    return Telemetry(
        now_s=now_s,
        armed=now.armed,
        base_mode=_CUSTOM | _STABILIZED | _kind(now.row.name, now.mode) | (_ARMED if now.armed else 0),
        custom_mode=now.custom_mode,
        system_status=status,
        landed_state=landed,
        estimate=now.estimate,
        battery=vehicle.battery,
        sensors=vehicle.sensors,
        rotors=vehicle.rotors,
        home_ned_m=now.home_ned_m,
        home_heading_rad=now.home_heading_rad,
        origin=(now.origin.latitude_deg, now.origin.longitude_deg, now.origin.altitude_m) if now.origin else None,
        global_fix=now.gps == "fused" and now.origin is not None and now.estimate.position_ok,
        armable=armable,
        present=present,
        enabled=enabled,
        health=health,
        ekf_flags=estimator_flags(now),
        mission_current=mission.current,
        mission_count=max(len(mission.items), mission.first),
        target_ned_m=getattr(activity, "place_ned_m", None) if now.armed else None,
        region_ned_m=now.region_ned_m,
        fence_breach=watch.breach,
        fence_breaches=watch.breaches,
        fence_breached_s=watch.breached_s,
    )


def _kind(firmware: str, mode: Mode) -> int:
    """Of the flags of a mode, those that either firmware sets."""
    if firmware == "ardupilot":
        return _MANUAL if mode in _SELF_LEVELLED else _MANUAL | _GUIDED
    return _MANUAL if mode in _BY_STICKS else _GUIDED | _AUTO
