"""A small house whose contents are hidden until somebody looks; steps of plans are carried out in it."""

from collections import Counter
from dataclasses import dataclass, field
from random import Random

from wire.catalogue import PROP_FLAG, catalogue
from wire.messages.plan import PlanNode
from wire.messages.world import AreaState, ObjectState, PropertyState, RobotState, WorldState
from wire.model import Vec2
from wire.site import Door as SiteDoor
from wire.site import Process, Site
from wire.site import Room as SiteRoom

SKILLS = (
    *("goto", "explore", "inspect", "pickup", "put", "open", "close"),
    *("toggle_on", "toggle_off", "slice", "clean"),
)
ROOMS = (
    ("kitchen", "Kitchen", (0.0, 0.0)),
    ("living-room", "LivingRoom", (5.0, 0.0)),
    ("bathroom", "Bathroom", (10.0, 0.0)),
    ("bedroom-1", "Bedroom", (0.0, 5.0)),
    ("bedroom-2", "Bedroom", (5.0, 5.0)),
)
DOORS = (
    ("kitchen", "living-room", (5.0, 2.0)),
    ("living-room", "bathroom", (10.0, 2.0)),
    ("kitchen", "bedroom-1", (2.0, 5.0)),
    ("living-room", "bedroom-2", (7.0, 5.0)),
)


def site() -> Site:
    rooms = tuple(
        SiteRoom(
            id=id,
            name=id.replace("-", " ").capitalize(),
            kind=kind,
            polygon_m=((x, y), (x + 5.0, y), (x + 5.0, y + 5.0), (x, y + 5.0)),
        )
        for id, kind, (x, y) in ROOMS
    )
    doors = tuple(
        SiteDoor(id=f"door-{i}", rooms=(a, b), start_m=(x - 0.4, y), end_m=(x + 0.4, y))
        for i, (a, b, (x, y)) in enumerate(DOORS)
    )
    return Site(name="toy", room=rooms, door=doors, process=(Process(id="planner", role="planner", module="planners"),))


@dataclass
class Thing:
    id: str
    type: str
    room: str
    at_m: Vec2
    props: dict[str, bool] = field(default_factory=dict)
    parent: str | None = None
    known: bool = False
    verified: bool = False
    known_props: dict[str, tuple[bool, float, str]] = field(default_factory=dict)
    looked_into: bool = False


@dataclass
class Dog:
    id: str
    at_m: Vec2
    room: str
    hand: str | None = None


class House:
    """The truth, and what is believed of it. Raises AssertionError when a plan breaks a precondition of a step."""

    def __init__(self, seed: int, dogs: int = 3, cameras: tuple[str, ...] = ()) -> None:
        self.rng = Random(seed)
        self.things: dict[str, Thing] = {}
        self.dogs = [Dog(f"dog-{i + 1}", (1.0 + i, 1.0), "kitchen") for i in range(dogs)]
        self.searched: set[str] = set()
        self.searches = Counter[str]()
        self.cameras = cameras
        self.steps = 0
        self.seq = 0
        self.broken: set[tuple[str, str]] = set()
        """(action, id) that always fails."""

    def add(self, type: str, room: str, inside: str | None = None, **props: bool) -> Thing:
        number = sum(t.type == type for t in self.things.values()) + 1
        x, y = next(origin for id, _, origin in ROOMS if id == room)
        at_m = (x + self.rng.uniform(0.4, 4.6), y + self.rng.uniform(0.4, 4.6))
        if inside is not None:
            at_m = self.things[inside].at_m
        has = {p: False for p, flag in PROP_FLAG.items() if catalogue()[type].can(flag)} | props
        thing = Thing(f"{type.lower()}-{number}", type, room, at_m, has, inside)
        self.things[thing.id] = thing
        return thing

    def look(self) -> None:
        """What cameras see all the time."""
        for thing in self.things.values():
            if thing.room in self.cameras and not self.hidden(thing):
                thing.known = True
                thing.known_props = {k: (v, 0.8, "cam-1") for k, v in thing.props.items()} | {
                    k: v for k, v in thing.known_props.items() if v[2] != "cam-1"
                }

    def hidden(self, thing: Thing) -> bool:
        holder = self.things.get(thing.parent or "")
        if holder is None:
            return False
        shut = catalogue()[holder.type].must_open and not holder.props["isOpen"]
        return shut or self.hidden(holder)

    def world(self) -> WorldState:
        self.look()
        self.seq += 1
        return WorldState(
            seq=self.seq,
            stamp_s=float(self.seq),
            robots=tuple(
                RobotState(
                    id=d.id,
                    kind="quadruped",
                    position_enu_m=(*d.at_m, 0.0),
                    yaw_deg=0.0,
                    status="idle",
                    inventory=d.hand,
                    skills=SKILLS,
                    stamp_s=float(self.seq),
                    room=d.room,
                )
                for d in self.dogs
            ),
            objects=tuple(self._believed(t) for t in self.things.values() if t.known),
            areas=tuple(
                AreaState(
                    id=id,
                    name=id.replace("-", " ").capitalize(),
                    kind=kind,
                    seen_fraction=1.0 if id in self.searched else 0.4 * (id in self.cameras),
                    camera_fraction=0.4 * (id in self.cameras),
                    searched=id in self.searched,
                    searches=self.searches[id],
                )
                for id, kind, _ in ROOMS
            ),
        )

    def _believed(self, t: Thing) -> ObjectState:
        return ObjectState(
            id=t.id,
            type=t.type,
            position_enu_m=(*t.at_m, 0.5),
            covariance_m2=(0.01, 0.0, 0.01, 0.01),
            receptacle=t.parent,
            props={
                k: PropertyState(value=v, confidence=c, source=s, stamp_s=0.0) for k, (v, c, s) in t.known_props.items()
            },
            room=t.room,
            source="dog-1" if t.verified else "cam-1",
            stamp_s=0.0,
            confidence=0.95 if t.verified else 0.8,
            verified=t.verified,
            looked_into=t.looked_into,
        )

    # Carrying out

    def see(self, dog: Dog, thing: Thing) -> None:
        thing.known = thing.verified = True
        thing.known_props = {k: (v, 0.95, dog.id) for k, v in thing.props.items()}

    def do(self, node: PlanNode, dog: Dog) -> str | None:
        """Carry one node out; a sentence when it fails."""
        self.steps += 1
        if (node.action, node.object or node.room or "") in self.broken:
            return f"{dog.id} could not {node.action} {node.object or node.room}: it does not work"
        if node.action == "explore":
            assert node.room is not None
            return self._explore(node, dog)
        thing = self.things[node.object or ""]
        assert not self.hidden(thing), f"{node.action} {thing.id} inside something closed"
        dog.at_m, dog.room = thing.at_m, thing.room
        self.see(dog, thing)
        for other in self.things.values():
            if other.parent == thing.id and not self.hidden(other):
                self.see(dog, other)
        self._handle(node, dog, thing)
        for other in self.things.values():
            if other.parent == thing.id and not self.hidden(other):
                self.see(dog, other)
        self.see(dog, thing)
        return None

    def _explore(self, node: PlanNode, dog: Dog) -> None:
        dog.room = node.room or ""
        dog.at_m = next((x + 2.5, y + 2.5) for id, _, (x, y) in ROOMS if id == node.room)
        inside = [t for t in self.things.values() if t.room == node.room and not self.hidden(t)]
        found = [t for t in inside if t.type in node.looking_for]
        for thing in found[:1] or inside:
            self.see(dog, thing)
        if not found:
            self.searched.add(node.room or "")
            self.searches[node.room or ""] += 1

    def _handle(self, node: PlanNode, dog: Dog, thing: Thing) -> None:
        if node.action == "pickup":
            assert dog.hand is None, "double grasp"
            assert not thing.props.get("isSliced"), "sliced things cannot be carried"
            assert catalogue()[thing.type].can("pickupable")
            dog.hand, thing.parent = thing.id, dog.id
        elif node.action == "put":
            assert node.item == dog.hand is not None, "puts what it does not hold"
            assert not catalogue()[thing.type].must_open or thing.props["isOpen"], "put into something closed"
            item = self.things[node.item]
            item.parent, item.room, item.at_m = thing.id, thing.room, thing.at_m
            dog.hand = None
        elif node.action == "slice":
            assert dog.hand is not None
            assert self.things[dog.hand].type == "Knife"
            thing.props["isSliced"] = True
        elif node.action == "clean":
            thing.props["isDirty"] = False
        elif node.action in ("open", "close"):
            if node.action == "open" and thing.type == "Microwave":
                assert not thing.props["isToggled"]
            thing.props["isOpen"] = node.action == "open"
        elif node.action == "inspect":
            thing.looked_into = thing.props.get("isOpen", False)
        elif node.action in ("toggle_on", "toggle_off"):
            if node.action == "toggle_on" and thing.type == "Microwave":
                assert not thing.props["isOpen"]
            thing.props["isToggled"] = node.action == "toggle_on"

    def truth(self) -> WorldState:
        kept = {t.id: (t.known, t.verified, t.known_props) for t in self.things.values()}
        for t in self.things.values():
            t.known, t.known_props = True, {k: (v, 1.0, "truth") for k, v in t.props.items()}
        world = self.world()
        for t in self.things.values():
            t.known, t.verified, t.known_props = kept[t.id]
        return world
