"""Without an indoor position system: a pose from outside, and an origin that somebody sets."""

import math

from sim.autopilot.interface import Ack
from tests.sim.autopilot.rig import ZURICH, item


def test_flies_by_a_pose_from_outside(rigs):
    for name in ("ardupilot", "px4"):
        rig = rigs(name, gps="none")
        assert rig.report.ekf_flags & 0x80
        assert rig.report.origin is None
        rig.every = lambda rig=rig: rig.firmware.external_pose(rig.true_ned, 0.0, rig.now_s)
        rig.fly(2.0)
        assert rig.report.health & 0x80
        assert rig.report.ekf_flags == 0x12F
        assert rig.report.armable
        assert rig.do(192, -1, 1, x=47.0, y=8.0, z=1.0, frame=3).result is rig.firmware.now.row.refused
        assert not rig.firmware.set_origin(math.nan, 8.0, 0.0)
        rig.take_off(1.0)
        assert rig.do(192, -1, 1, 0, 0, x=47.0, y=8.0, z=1.0, frame=3).result is Ack.DENIED
        assert rig.heard("SET_GPS_GLOBAL_ORIGIN")
        assert rig.firmware.check_item(0, item(1, 16, 47.0, 8.0, 1.0, frame=3)) == 2
        assert rig.firmware.set_origin(*ZURICH)
        assert rig.report.origin == ZURICH
        assert rig.report.ekf_flags == 0x33F
        assert not rig.report.global_fix
        assert rig.do(192, -1, 1, 0, 0, x=ZURICH[0], y=ZURICH[1], z=1.5, frame=3).result is Ack.ACCEPTED
        assert rig.fly(5, lambda rig=rig: rig.off(0.0, 0.0, -1.5) < 0.2)
        rig.every = None
        assert rig.fly(4, lambda rig=rig: rig.in_mode("land"))
        assert not rig.report.health & 0x80


def test_a_pose_kilometres_away_is_rejected_in_words(rigs):
    for name in ("ardupilot", "px4"):
        rig = rigs(name, gps="none")
        rig.every = lambda rig=rig: rig.firmware.external_pose(rig.true_ned, 0.0, rig.now_s)
        rig.fly(2.0)
        rig.take_off(1.0)
        for far_m in (1500.0, 50_000.0):
            rig.said.clear()
            rig.firmware.external_pose((far_m, 0.0, -1.0), 0.0, rig.now_s + 1e-3)
            rig.fly(2.0)
            assert rig.heard("External pose rejected")
            assert rig.off(0.0, 0.0, -1.0) < 0.3
