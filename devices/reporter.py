"""What a device says of itself: its state ten times a second, or twice while it stands idle, and its progress."""

from math import hypot, inf

from devices.worker import Pose
from wire.bus import Node
from wire.messages.command import Progress, RobotReport
from wire.messages.world import RobotStatus

REPORT_S, IDLE_REPORT_S, PROGRESS_S = 0.1, 0.5, 0.5
STANDS_MPS = 0.02
EARLY_S = 1e-6
"""Periods are reached in floating-point steps."""


class Reporter:
    def __init__(self, id: str) -> None:
        self.id = id
        self._progress_due_s = 0.0
        self._told_s, self._told_idle = -inf, False
        """When it last reported, and whether it stood idle."""
        self._seq = 0

    def start(self, node: Node) -> None:
        self._node = node

    def tell(self, now_s: float, pose: Pose | None, status: RobotStatus, goal_id: str | None) -> None:
        """Publish a report when one is due; nothing before the body knows where it is."""
        if pose is None:
            return
        stands = hypot(*(pose.velocity_enu_mps or ())) < STANDS_MPS and not pose.airborne
        idle = status == "idle" and stands and not pose.path_m
        period_s = IDLE_REPORT_S if idle and self._told_idle else REPORT_S
        if 0.0 <= now_s - self._told_s < period_s - EARLY_S:
            return
        self._told_s, self._told_idle = now_s, idle
        self._seq += 1
        report = RobotReport(
            robot=self.id,
            seq=self._seq,
            stamp_s=now_s,
            position_enu_m=pose.position_enu_m,
            yaw_rad=pose.yaw_rad,
            status=status,
            holding=pose.holding,
            holding_type=pose.holding_type,
            goal_id=goal_id,
            path_m=pose.path_m,
            travelled_m=pose.travelled_m,
            action_steps=pose.action_steps,
            velocity_enu_mps=pose.velocity_enu_mps,
            path_heights_m=pose.path_heights_m,
            airborne=pose.airborne,
            battery=pose.battery,
            endurance_s=round(pose.endurance_s) if pose.endurance_s is not None else None,
        )
        self._node.publish("robot_report", report, self.id)

    def tell_progress(self, now_s: float, goal_id: str, fraction: float, note: str) -> None:
        if now_s < self._progress_due_s - EARLY_S:
            return
        self._progress_due_s = now_s + PROGRESS_S
        progress = Progress(goal_id=goal_id, robot=self.id, stamp_s=now_s, fraction=fraction, note=note[:2000])
        self._node.publish("progress", progress, self.id)
