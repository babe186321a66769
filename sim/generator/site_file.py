"""The site file of a generated home: what its owner would know. Floor plan and cameras, and no object at all."""

from dataclasses import dataclass
from math import degrees

from sim.generator.starts import TOGETHER
from sim.scene import CctvPose, Door, Room, Scene, Wall

Value = str | int | float | bool | tuple["Value", ...]


MAVLINK_PORT = 14600
"""Of the first drone. Not 14540 or 14550: any simulated autopilot on this computer sends there unasked."""
DRONE_SPEED = 2.0
"""Clients of an autopilot have clocks of their own: with a drone in it, simulated time runs no faster than this."""


@dataclass(frozen=True)
class Options:
    """What a site file says besides the building. Ports: of the router, of the view."""

    name: str | None = None
    robots: int = 3
    drones: int = 0
    firmware: str = "ardupilot"
    mavlink_port: int = MAVLINK_PORT
    """Where the first drone looks for its autopilot, the next one at the next port."""
    spread: bool = False
    """Robots begin all over the home rather than side by side."""
    cctv: bool = True
    clock: str = "lockstep"
    planner: str = "scripted"
    port: int = 7447
    view_port: int = 9876
    save: str = ""
    smart_appliances: bool = False
    faults: tuple[dict[str, Value], ...] = ()
    """Rows of `[[sim.fault]]`."""


def write_site(scene: Scene, options: Options | None = None) -> str:
    """TOML that `wire.site.load_site` takes."""
    options = options or Options()
    cameras = scene.cameras if options.cctv else ()
    most = len(scene.robot_starts)
    if not 1 <= options.robots <= most:
        raise ValueError(f"{options.robots} robots asked for: this home has starts for 1 to {most}")
    if not 0 <= options.drones <= most - options.robots:
        raise ValueError(
            f"{options.drones} drones asked for: beside {options.robots} robots this home has starts for {most - options.robots}"
        )
    starts = scene.robot_starts[-options.robots :] if options.spread else scene.robot_starts[: options.robots]
    apart = (*scene.robot_starts[TOGETHER:], *scene.robot_starts[:TOGETHER])  # where no walker begins or soon passes
    drones = [start for start in apart if start not in starts][: options.drones]
    clock: dict[str, Value] = {"mode": options.clock}
    if drones:
        clock["speed"] = DRONE_SPEED
    sim: dict[str, Value] = {"seed": scene.seed, "smart_appliances": options.smart_appliances}
    if drones:
        sim["firmware"] = options.firmware
    tables = [
        _table("", {"name": options.name or f"home-{scene.seed}"}),
        _table("[router]", {"endpoint": f"tcp/127.0.0.1:{options.port}"}),
        _table("[clock]", clock),
        _table("[planner]", {"name": options.planner}),
        _table("[view]", {"grpc_port": options.view_port, "save": options.save}),
        _table("[sim]", sim),
        *(_table("[[sim.fault]]", row) for row in options.faults),
        *(_room(room) for room in scene.rooms),
        *(_wall(wall) for wall in scene.walls),
        *(_door(door) for door in scene.doors),
        *(_camera(pose) for pose in cameras),
        *(
            _table("[[robot]]", {"id": f"dog-{k}", "kind": "quadruped", "start_m": at, "start_yaw_deg": _deg(yaw)})
            for k, (at, yaw) in enumerate(starts, start=1)
        ),
        *(
            _table(
                "[[robot]]",
                {
                    "id": f"drone-{k}",
                    "kind": "drone",
                    "start_m": at,
                    "start_yaw_deg": _deg(yaw),
                    "link": f"udpin://127.0.0.1:{options.mavlink_port + k - 1}",
                },
            )
            for k, (at, yaw) in enumerate(drones, start=1)
        ),
        *(_table("[[process]]", row) for row in _processes(len(cameras), options.robots, len(drones))),
    ]
    return "\n".join(tables)


def read_fault(text: str) -> dict[str, Value]:
    """A row of `[[sim.fault]]` from DEVICE:KIND[:VALUE]: probability, seconds of delay, or property. ValueError."""
    device, _, rest = text.partition(":")
    kind, _, value = rest.partition(":")
    field = {"frame_loss": "probability", "delay": "delay_s", "wrong_state": "prop"}.get(kind)
    if field is None:
        raise ValueError(
            f"fault '{text}': give DEVICE:KIND[:VALUE], as in cam-1:frame_loss:0.3 (a probability), "
            "cam-1:delay:0.5 (seconds) or television-1:wrong_state:isToggled (a property)"
        )
    row: dict[str, Value] = {"device": device, "kind": kind}
    if value and field == "prop":
        row[field] = value
    elif value:
        try:
            row[field] = float(value)
        except ValueError:
            raise ValueError(f"fault '{text}': {value} is no number") from None
    return row


def _processes(cameras: int, robots: int, drones: int) -> list[dict[str, Value]]:
    rows = [
        ("router", "router", "wire.router"),
        ("sim", "sim", "sim"),
        ("hub", "hub", "hub"),
        ("planner", "planner", "planners"),
        ("view", "view", "hub.view"),
        *((f"cctv-{k}", "cctv", "devices.cctv") for k in range(1, cameras + 1)),
        *((f"dog-{k}", "robot", "devices.quadruped") for k in range(1, robots + 1)),
        *((f"drone-{k}", "robot", "devices.drone") for k in range(1, drones + 1)),
    ]
    return [{"id": id, "role": role, "module": module} for id, role, module in rows]


def _room(room: Room) -> str:
    return _table("[[room]]", {"id": room.id, "name": room.name, "kind": room.kind, "polygon_m": tuple(room.polygon_m)})


def _wall(wall: Wall) -> str:
    return _table("[[wall]]", {"start_m": wall.start_m, "end_m": wall.end_m, "thickness_m": wall.thickness_m})


def _door(door: Door) -> str:
    return _table("[[door]]", {"id": door.id, "rooms": door.rooms, "start_m": door.start_m, "end_m": door.end_m})


def _camera(pose: CctvPose) -> str:
    return _table(
        "[[camera]]",
        {
            "id": pose.id,
            "room": pose.room,
            "position_enu_m": pose.position_m,
            "yaw_deg": _deg(pose.yaw_rad),
            "tilt_down_deg": _deg(pose.tilt_down_rad),
            "width_px": pose.width_px,
            "height_px": pose.height_px,
            "focal_px": pose.focal_px,
        },
    )


def _deg(angle_rad: float) -> float:
    return round(degrees(angle_rad), 4)


def _table(head: str, row: dict[str, Value]) -> str:
    lines = [head] if head else []
    return "\n".join([*lines, *(f"{key} = {_text(value)}" for key, value in row.items())]) + "\n"


def _text(value: Value) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, tuple):
        return "[" + ", ".join(_text(v) for v in value) + "]"
    return repr(value)
