"""A small flat and the messages of its inhabitants, for the hub's tests."""

from wire.messages.command import DeviceCard, RobotReport
from wire.messages.observation import ObjectObservation, ObservationBatch, View
from wire.messages.plan import SkillCard
from wire.site import Camera, Door, Process, Robot, Room, Site, Wall

ACTIONS = ("goto", "explore", "inspect", "pickup", "put", "open", "close", "toggle_on", "toggle_off", "slice", "clean")


def flat() -> Site:
    """Two rooms of 4 x 4 m side by side with a door of 0.9 m between them, and a hall beyond the second."""
    rooms = (
        Room(id="kitchen", name="Kitchen", kind="Kitchen", polygon_m=((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0))),
        Room(id="living", name="Living", kind="LivingRoom", polygon_m=((4.0, 0.0), (8.0, 0.0), (8.0, 4.0), (4.0, 4.0))),
        Room(id="bath", name="Bath", kind="Bathroom", polygon_m=((8.0, 0.0), (12.0, 0.0), (12.0, 4.0), (8.0, 4.0))),
    )
    doors = (
        Door(id="door-1", rooms=("kitchen", "living"), start_m=(4.0, 1.55), end_m=(4.0, 2.45)),
        Door(id="door-2", rooms=("living", "bath"), start_m=(8.0, 1.55), end_m=(8.0, 2.45)),
    )
    walls = tuple(
        Wall(start_m=(x, low), end_m=(x, high)) for x in (4.0, 8.0) for low, high in ((0.0, 1.55), (2.45, 4.0))
    )
    return Site(
        name="flat",
        room=rooms,
        wall=walls,
        door=doors,
        camera=(
            Camera(
                id="cam-1",
                room="kitchen",
                position_enu_m=(0.1, 0.1, 2.3),
                yaw_deg=45.0,
                tilt_down_deg=30.0,
                width_px=640,
                height_px=480,
                focal_px=320.0,
            ),
        ),
        robot=(
            Robot(id="dog-1", kind="quadruped", start_m=(1.0, 1.0)),
            Robot(id="dog-2", kind="quadruped", start_m=(6.0, 1.0)),
        ),
        process=(
            Process(id="hub", role="hub", module="hub"),
            Process(id="planner", role="planner", module="planners"),
        ),
    )


def seen(
    type: str,
    x: float,
    y: float,
    z: float,
    track: str = "t1",
    sigma_m: float = 0.08,
    confidence: float = 0.9,
    **props: float,
) -> ObjectObservation:
    v = sigma_m**2
    return ObjectObservation(
        track=track,
        type=type,
        confidence=confidence,
        position_enu_m=(x, y, z),
        covariance_m2=(v, 0.0, v, v),
        props=dict(props),
    )


def batch(
    source: str, stamp_s: float, *objects: ObjectObservation, view: View | None = None, seq: int = 0
) -> ObservationBatch:
    kind = "robot" if source.startswith("dog") else "cctv"
    return ObservationBatch(source=source, boot_id="b", seq=seq, stamp_s=stamp_s, kind=kind, objects=objects, view=view)


def view(x: float, y: float, half_m: float = 2.0) -> View:
    """A square of floor seen from the middle of its west side."""
    return View(
        origin_enu_m=(x, y, 1.3),
        polygon_m=(
            (x, y - half_m),
            (x + 2 * half_m, y - half_m),
            (x + 2 * half_m, y + half_m),
            (x, y + half_m),
        ),
        yaw_rad=0.0,
        hfov_rad=1.57,
        range_m=6.0,
    )


def card(robot: str, skills: tuple[str, ...] = ACTIONS) -> DeviceCard:
    return DeviceCard(
        id=robot,
        kind="quadruped",
        boot_id="b",
        skills=tuple(SkillCard(name=s, doc=s, parameters="{}") for s in skills),
        payload_kg=2.0,
        radius_m=0.38,
        speed_mps=0.5,
    )


def report(robot: str, x: float, y: float, stamp_s: float, **more: object) -> RobotReport:
    return RobotReport.model_validate(
        {
            "robot": robot,
            "seq": int(stamp_s * 20),
            "stamp_s": stamp_s,
            "position_enu_m": (x, y, 0.3),
            "yaw_rad": 0.0,
            "status": "idle",
            **more,
        }
    )
