"""The whole mesh in two tables: what is published, and what can be asked.

A key is `<realm>/<path>`; `{id}` stands for the device, robot or process. `publishers` and `subscribers` name roles
(`ROLES`); access control on the router is generated from these columns, so what is not written here cannot be said.
"""

from dataclasses import dataclass
from typing import Literal

from wire.messages import clock, command, driver, look, observation, operator, plan, truth, world
from wire.model import Message

Role = Literal["hub", "planner", "cctv", "robot", "sim", "view", "console", "evaluator"]
ROLES: tuple[Role, ...] = ("hub", "planner", "cctv", "robot", "sim", "view", "console", "evaluator")
EVERYONE: tuple[Role, ...] = ROLES
FOLLOWERS: tuple[Role, ...] = ("hub", "planner", "cctv", "robot")
"""Who decides something holds time up in lockstep; who only looks on does not."""

Delivery = Literal["every", "latest"]
"""every: blocks rather than drops, in order. latest: a slow reader sees the newest only."""


@dataclass(frozen=True)
class Topic:
    """One family of published keys."""

    name: str
    path: str
    message: type[Message]
    delivery: Delivery
    rate_hz: float
    """Upper end of the normal rate of one publisher; 0 when published on events."""
    publishers: tuple[Role, ...]
    subscribers: tuple[Role, ...]
    about: str


@dataclass(frozen=True)
class Service:
    """One family of keys that answer a request."""

    name: str
    path: str
    request: type[Message]
    reply: type[Message]
    timeout_s: float
    servers: tuple[Role, ...]
    callers: tuple[Role, ...]
    about: str


# fmt: off
TOPICS: tuple[Topic, ...] = (
    Topic("tick", "clock/tick", clock.Tick, "every", 20.0,
          ("sim",), ("view", "console", "evaluator"), "simulated time moves one step: for those who look on"),
    Topic("turn", "clock/turn/{id}", clock.Tick, "every", 20.0,
          ("sim",), FOLLOWERS, "simulated time has moved on, and this follower is waited for"),
    Topic("tick_done", "clock/done/{id}", clock.TickDone, "every", 20.0,
          FOLLOWERS, ("sim",), "a follower is through with a step"),
    Topic("health", "health/{id}", clock.Health, "latest", 2.0,
          EVERYONE, ("hub", "robot", "view", "console"), "a process's deciding loop is alive"),
    Topic("frame", "camera/{id}/image", driver.CameraFrame, "latest", 2.0,
          ("sim", "cctv", "robot"), ("cctv", "robot", "view"), "pictures"),
    Topic("odometry", "robot/{id}/odometry", driver.Odometry, "latest", 20.0,
          ("sim", "robot"), ("robot", "view"), "where a robot's localisation says it is"),
    Topic("scan", "robot/{id}/scan", driver.LaserScan, "latest", 10.0,
          ("sim", "robot"), ("robot", "view"), "a sweep of ranges around a robot"),
    Topic("velocity", "robot/{id}/velocity", driver.VelocityCommand, "latest", 20.0,
          ("robot",), ("sim",), "how fast a robot should move"),
    Topic("gripper_command", "robot/{id}/gripper/command", driver.GripperCommand, "every", 0.0,
          ("robot",), ("sim",), "manipulate what is at a point"),
    Topic("gripper_state", "robot/{id}/gripper/state", driver.GripperState, "every", 5.0,
          ("sim",), ("robot",), "what came of it, and what the hand holds"),
    Topic("device_report", "appliance/{id}/report", driver.DeviceReport, "every", 0.2,
          ("sim",), ("hub", "view"), "what a smart appliance says of itself"),
    Topic("observation", "observation/{id}", observation.ObservationBatch, "every", 2.0,
          ("cctv", "robot"), ("hub", "view"), "what a source claims to see"),
    Topic("event", "event/{id}", observation.EventLog, "every", 0.0,
          ("cctv", "robot", "hub"), ("hub", "view", "console"), "time-stamped text log"),
    Topic("world_delta", "world/delta", world.WorldDelta, "every", 10.0,
          ("hub",), ("view", "console", "planner", "robot", "cctv"), "changes of the fused world state"),
    Topic("robot_report", "robot/{id}/report", command.RobotReport, "every", 10.0,
          ("robot",), ("hub", "view", "console"), "a robot's own state"),
    Topic("traffic", "robot/{id}/traffic", command.TrafficOrder, "latest", 10.0,
          ("hub",), ("robot", "view"), "go, stand, or step aside"),
    Topic("progress", "robot/{id}/progress", command.Progress, "latest", 2.0,
          ("robot",), ("hub", "view", "console"), "how far a goal has come"),
    Topic("result", "robot/{id}/result", command.Result, "every", 0.0,
          ("robot",), ("hub", "view"), "how a goal ended"),
    Topic("plan_state", "plan/state", plan.PlanState, "every", 0.0,
          ("hub",), ("view", "console"), "the running plan"),
    Topic("task_state", "task/{id}/state", operator.TaskState, "every", 0.0,
          ("hub",), ("view", "console"), "how a task stands"),
    Topic("truth", "gt/state", truth.TruthState, "latest", 2.0,
          ("sim",), ("evaluator",), "the world as it is: for the evaluator alone"),
)
# fmt: on

# fmt: off
SERVICES: tuple[Service, ...] = (
    Service("card", "device/{id}/card", command.CardRequest, command.DeviceCard, 1.0,
            ("cctv", "robot"), ("hub",), "who a device is and what it can do"),
    Service("goal", "robot/{id}/goal", command.Command, command.CommandAck, 1.0,
            ("robot",), ("hub",), "take on one skill; journaled before the answer"),
    Service("cancel", "robot/{id}/cancel", command.CancelRequest, command.CommandAck, 1.0,
            ("robot",), ("hub",), "stop a goal"),
    Service("goals", "robot/{id}/goals", command.GoalsRequest, command.GoalsReply, 1.0,
            ("robot",), ("hub",), "every goal a device remembers"),
    Service("make_plan", "planner/plan", plan.PlanRequest, plan.PlanReply, 60.0,
            ("planner",), ("hub",), "turn a task and a world into a plan or a refusal"),
    Service("look_at", "planner/look", look.LookRequest, look.LookReply, 120.0,
            ("planner",), ("cctv", "robot"), "show a vision model one picture; plans go before"),
    Service("snapshot", "world/snapshot", world.SnapshotRequest, world.WorldState, 2.0,
            ("hub",), ("view", "console", "planner", "robot", "cctv"), "the whole fused world state"),
    Service("task", "hub/task", operator.TaskRequest, operator.TaskState, 5.0,
            ("hub",), ("console",), "start a task"),
    Service("task_query", "hub/task/query", operator.TaskQuery, operator.TaskState, 2.0,
            ("hub",), ("console", "view"), "how a task stands"),
    Service("calls", "hub/task/calls", operator.CallsRequest, operator.CallsReply, 2.0,
            ("hub",), ("console", "view"), "every call of a model that was made for a task"),
    Service("control", "hub/control", operator.ControlRequest, operator.ControlReply, 2.0,
            ("hub",), ("console",), "stop, pause, resume, cancel"),
    Service("why", "hub/why", operator.WhyRequest, operator.WhyReply, 2.0,
            ("hub",), ("console", "view"), "where something is believed to be, and who said so"),
    Service("judge", "gt/judge", truth.JudgeRequest, truth.JudgeReply, 5.0,
            ("sim",), ("evaluator",), "judge goals from the world as it is"),
)
# fmt: on

TOPIC = {topic.name: topic for topic in TOPICS}
SERVICE = {service.name: service for service in SERVICES}
PRESENCE_PATH = "alive/{id}"
"""Liveliness token of a process; its role is announced in its device card or health."""
