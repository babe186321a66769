"""The site file (TOML): what the owner knows of the building and what runs where. Frozen models, no unknown fields."""

import os
import tomllib
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError

from wire.faults import describe
from wire.model import Id, Message, Vec2, Vec3, Word
from wire.planner_table import PlannerChoice
from wire.site_faults import site_faults

UNDER_CEILING_M = 0.4
"""What flies stays so far below a ceiling."""


class SiteError(ValueError):
    """The site file is wrong; the text names the place and the remedy."""


class Room(Message):
    id: Id
    name: str
    kind: Literal["Kitchen", "LivingRoom", "Bedroom", "Bathroom", "Other"]
    polygon_m: tuple[Vec2, ...] = Field(min_length=3)
    height_m: float = Field(default=2.5, gt=0.0)
    """Of its ceiling; only what flies asks."""


class Wall(Message):
    start_m: Vec2
    end_m: Vec2
    thickness_m: float = Field(default=0.1, gt=0.0)


class Door(Message):
    """A gap between two rooms; start and end are its jambs."""

    id: Id
    rooms: tuple[Id, Id]
    start_m: Vec2
    end_m: Vec2
    height_m: float = Field(default=2.0, gt=0.0)
    """Of its lintel; only what flies asks."""


Perception = Literal["embedded", "vlm", "both"]
"""Who looks at a camera's pictures: the shipped detector, a vision model behind the planner's process, or both."""


class Camera(Message):
    """A fixed camera with its calibration. `source`: `mesh` for frames on the mesh, else a URL, a path or a number."""

    id: Id
    room: Id | None = None
    position_enu_m: Vec3
    yaw_deg: float
    tilt_down_deg: float
    width_px: int = Field(gt=0)
    height_px: int = Field(gt=0)
    focal_px: float = Field(gt=0.0)
    source: str = "mesh"
    picture_hz: float = Field(default=2.0, gt=0.0, le=60.0)
    perception: Perception = "embedded"
    look_every_s: float = Field(default=10.0, ge=1.0, le=3600.0)
    """A vision model is shown no more than one picture in this time."""


class Robot(Message):
    id: Id
    """That of its process."""
    kind: Word
    """`quadruped` walks on `devices.quadruped`, `drone` flies on `devices.drone`; any other is your own device's."""
    start_m: Vec2
    start_yaw_deg: float = 0.0
    lost_hub_s: float = Field(default=2.0, gt=0.0)
    """Stand still, or hover, after this long without the hub."""
    link: str | None = None
    """A drone's autopilot: `udpin://`, `udpout://` or `tcpout://` with HOST:PORT, `serial://` with DEVICE:BAUD."""
    land_after_s: float = Field(default=10.0, ge=0.0)
    """A drone that hovers for want of the hub lands after this."""
    idle_home_s: float = Field(default=30.0, ge=0.0)
    """A drone that has hovered without a goal for this long flies home and lands; 0: it hovers on."""
    flight_height_m: float = Field(default=1.5, ge=0.5, le=50.0)
    """Where a drone flies when nobody says how high."""
    origin_enu_m: Vec3 = (0.0, 0.0, 0.0)
    """Where the local frame of a drone's autopilot has its origin."""
    north_deg: float = Field(default=90.0, ge=-360.0, le=360.0)
    """Where that frame's north points: 90 when the site's y axis does."""


class Process(Message):
    """One process of the mesh: `python -m <module> --site FILE --id <id>`."""

    id: Id
    role: Literal["router", "hub", "planner", "cctv", "robot", "sim", "view"]
    module: str = Field(pattern=r"^[a-z_][a-z0-9_.]*$", description="a Python module, such as devices.cctv")
    host: str = "localhost"
    args: tuple[Annotated[str, Field(pattern=r"^[^\x00-\x1f]*$")], ...] = ()
    autostart: bool = True


class Router(Message):
    endpoint: str = Field(
        default="tcp/127.0.0.1:7447",
        pattern=r"^tcp/[^/]+:\d+$",
        description="tcp/HOST:PORT, such as tcp/127.0.0.1:7447",
    )
    secured: bool = True


class Clock(Message):
    """`wall`: real time. `lockstep`: the simulator owns time and waits for its followers, as fast as they are.

    A file without a `[sim]` table that says nothing of the mode means `wall`.
    """

    mode: Literal["wall", "lockstep"] = "lockstep"
    step_s: float = Field(default=0.05, gt=0.0, le=1.0)
    speed: float = Field(default=0.0, ge=0.0)
    """Upper bound on simulated seconds per second; 0 is none."""


class Fault(Message):
    """Something the simulator does wrong on purpose to a camera, an appliance or a robot."""

    device: Id
    kind: Literal["frame_loss", "delay", "wrong_state"]
    probability: Annotated[float, Field(ge=0.0, le=1.0)] = 1.0
    delay_s: float = Field(default=0.0, ge=0.0)
    prop: Word | None = None


class Sim(Message):
    """The simulated building behind the drivers. Only the simulator reads this table."""

    scene: Literal["home"] = "home"
    seed: int = Field(ge=0)
    smart_appliances: bool = False
    legs: bool = False
    renderer: Literal["auto", "gl", "bullet", "none"] = "auto"
    """`none`: no pictures at all, for robots that walk by lidar."""
    fault: tuple[Fault, ...] = ()
    firmware: Literal["ardupilot", "px4"] = "ardupilot"
    """Whose habits the autopilots of the drones in it have."""
    mavlink_out: tuple[Annotated[str, Field(pattern=r"^[A-Za-z0-9_.-]+:\d{1,5}$")], ...] = ()
    """HOST:PORT of ground stations that are sent every drone's telemetry, such as 127.0.0.1:14550."""


class View(Message):
    """The Rerun process: where live viewers connect, and a file that takes everything when one is named."""

    grpc_port: int = Field(default=9876, gt=0, lt=65536)
    web_port: int = Field(default=9090, gt=0, lt=65536)
    memory_limit: str = Field(default="64MiB", pattern=r"^\d+(KiB|MiB|GiB)$", description="a size, such as 64MiB")
    save: str = ""


class Hub(Message):
    max_fails: int = Field(default=5, ge=1)
    """MAX_FAILS of Algorithm 1."""


class Site(Message):
    name: str = Field(
        pattern=r"^[^./;\"\x00-\x1f][^/;\"\x00-\x1f]{0,59}$",
        description="a name of at most 60 characters, without slashes, semicolons and quotes, no dot in front",
    )
    """Also the name of the folder in which its mesh keeps its things: no slash, no dot in front."""
    realm: Id = "r2x"
    router: Router = Router()
    clock: Clock = Clock()
    hub: Hub = Hub()
    planner: PlannerChoice = PlannerChoice()
    view: View = View()
    room: tuple[Room, ...]
    wall: tuple[Wall, ...] = ()
    door: tuple[Door, ...] = ()
    camera: tuple[Camera, ...] = ()
    robot: tuple[Robot, ...] = ()
    process: tuple[Process, ...]
    sim: Sim | None = None


def load_site(path: Path) -> Site:
    """Read and check a site file. Raises SiteError with one sentence per fault."""
    try:
        data = tomllib.loads(path.read_text())
    except FileNotFoundError:
        raise SiteError(f"{path}: no such site file; `justw sites` lists the ones there are") from None
    except OSError as error:
        raise SiteError(f"{path}: cannot be read: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise SiteError(f"{path}: not valid TOML: {error}") from None
    return parse_site(data, str(path))


def parse_site(data: dict[str, Any], where: str) -> Site:
    """Check what was read from `where`."""
    try:
        site = Site.model_validate(_tuples(_on_its_clock(data)))
    except ValidationError as error:
        raise SiteError(f"{where}: {describe(error, Site)}") from None
    faults = list(site_faults(site))
    if faults:
        raise SiteError(f"{where}: {'; '.join(faults)}")
    return site


def _on_its_clock(data: dict[str, Any]) -> dict[str, Any]:
    """A building that nobody simulates lives by the wall clock, whether or not its file says so."""
    clock = data.get("clock", {})
    if "sim" in data or not isinstance(clock, dict):
        return data
    return {**data, "clock": {"mode": "wall", **clock}}


def _tuples(value: Any) -> Any:
    """TOML arrays as tuples, which is what strict models take."""
    if isinstance(value, list):
        return tuple(_tuples(v) for v in value)
    if isinstance(value, dict):
        return {k: _tuples(v) for k, v in value.items()}
    return value


STATE_VARIABLE = "R2X_STATE"


def state_dir(site: Site) -> Path:
    """Where this site's processes keep what must outlive them (journals); made when missing."""
    folder = Path(os.environ.get(STATE_VARIABLE) or Path(".run") / site.name)
    folder.mkdir(parents=True, exist_ok=True)
    return folder
