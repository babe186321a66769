"""W = (robots, objects, areas): equation 1, its transition F (equation 5), and what changed since the last delta."""

from collections.abc import Mapping
from math import hypot

from hub.absence import Absences
from hub.areas import Areas
from hub.association import duplicates
from hub.containment import FARTHEST, LEAST_HOLDER, hidden, parent_of
from hub.denials import Denials
from hub.facts import claim, settle
from hub.fleet import Fleet, Robot
from hub.floor import FloorPlan
from hub.fusion import Fusion
from hub.kinds import shapes
from hub.records import Fact, Thing
from hub.showing import due, show, state
from hub.things import Things
from hub.trust import Trust
from wire.messages.command import RobotReport
from wire.messages.driver import DeviceReport
from wire.messages.observation import ObjectObservation, ObservationBatch
from wire.messages.world import WorldDelta, WorldState
from wire.site import Site

_PLACED_M = 0.09
_RESETTLED_M = 0.15
"""Furniture that is believed this far from where it was has its neighbours' parents worked out again."""
_TAKEN_FOR = 12.0
"""Votes that it takes to undo that a plan took a thing for something else."""
_SWEEP_S = 5.0
_MERGE_S = 1.0
_TENTATIVE_S = 20.0


class World:
    """The belief of the hub. `observe`, `report` and the effects of results (`hub.effects`) change it."""

    def __init__(self, site: Site, seed: int = 0) -> None:
        self.floor = FloorPlan(site)
        self.things = Things(seed)
        self.trust = Trust()
        self.areas = Areas(site.room)
        self.fleet = Fleet(self.floor)
        self.fusion = Fusion(self.things, self.trust, self.fleet.near)
        self._absences = Absences(self.fusion, lambda thing: hidden(thing, self.things))
        self.denials = Denials()
        self.seq = 0
        self._robots: frozenset[str] = frozenset()
        self._locks_due = False
        self._swept_s = self._merged_s = 0.0
        self._unmerged: dict[str, Thing] = {}
        """What changed since duplicates were last looked for."""

    def observe(self, batch: ObservationBatch) -> None:
        """F(W, u) for a picture."""
        mark = self.fusion.take(batch)
        if batch.gone or batch.view is not None:
            self._absences.take(batch, mark)
            self.areas.take(batch)
        if batch.kind == "robot" and batch.source not in self._robots:
            self._robots = self._robots | {batch.source}

    def report_robot(self, report: RobotReport) -> Robot:
        """F(W, u) for a robot's own state; what it carries goes with it."""
        robot = self.fleet.take(report)
        self._robots = self._robots | {robot.id} if robot.id not in self._robots else self._robots
        carried = self.things.get(robot.inventory)
        if carried is None:
            return robot
        if not report.holding and report.status == "idle":
            self._dropped(carried, robot.id)
        else:
            self.things.move(carried, (robot.position_m[0], robot.position_m[1], 0.6))
            carried.stamp_s, carried.last_source = max(carried.stamp_s, report.stamp_s), robot.id
            self.things.touch(carried)
        return robot

    def _dropped(self, thing: Thing, robot: str) -> None:
        self.fleet.robot(robot).inventory = None
        thing.xx = thing.yy = 0.5
        self.place(thing, None)

    def report_device(self, report: DeviceReport) -> None:
        """F(W, u) for what an appliance says of itself: it is there, and in what state."""
        seen = ObjectObservation(
            track=report.device[:16],
            type=report.type,
            confidence=0.99,
            position_enu_m=report.position_enu_m,
            covariance_m2=(0.01, 0.0, 0.01, 0.01),
            props=report.props,
        )
        self.observe(
            ObservationBatch(
                source=report.device, boot_id="", seq=report.seq, stamp_s=report.stamp_s, kind="device", objects=(seen,)
            )
        )

    def place(self, thing: Thing, receptacle: str | None) -> None:
        """Re-parent a thing."""
        thing.receptacle = receptacle
        thing.placed_x, thing.placed_y, thing.placed_z = thing.x, thing.y, thing.z
        thing.room = self.floor.room_at(thing.x, thing.y)
        thing.version += 1
        self._locks_due = True
        self.things.settle(thing)
        self.things.touch(thing)

    def property_of(self, thing: Thing, name: str) -> Fact:
        """The fact, made when nobody has spoken of it yet; the next delta weighs it again."""
        self.things.touch(thing)
        return thing.facts.setdefault(name, Fact())

    def take_for(self, types: Mapping[str, str]) -> list[str]:
        """Believe things to be of other types until looks say otherwise again; a line for each that changed."""
        lines = []
        for id, type in types.items():
            thing = self.things.get(id)
            if thing is not None and thing.type != type and type in shapes():
                lines.append(f"the {thing.type} {id} is taken for the {type}, which was found nowhere")
                thing.votes[type] = sum(thing.votes.values()) + _TAKEN_FOR
                thing.retype(type)
                thing.version += 1
                self.things.touch(thing)
        return lines

    def begin_task(self) -> None:
        """What goals ask a robot to have seen or searched counts from now."""
        self.areas.begin_task()
        for thing in self.things:
            if thing.from_above or thing.looked_into:
                thing.from_above = thing.looked_into = False
                thing.version += 1
                self.things.touch(thing)
            if thing.verified and thing.receptacle not in self.fleet.robots:
                thing.verified = False
                thing.first_hand_s = -1e9
                thing.version += 1
                self.things.touch(thing)

    def settle(self, now_s: float) -> list[Thing]:
        """Work out rooms, parents, properties and doubt of what was touched; those a reader should hear of."""
        touched = self.things.touched
        later: list[Thing] = []
        self.things.touched = later
        for thing in touched:
            thing.touched = False
            if thing.id in self.things.by_id:
                self._review(thing, now_s)
                self._unmerged[thing.id] = thing
        if self._locks_due:
            self.lock()
        there = [t for t in (*touched, *later) if t.id in self.things.by_id]
        changed = [t for t in there if due(t, now_s) and (t.shown >= 0 or self.denials.rename(t, now_s))]
        return list({t.id: t for t in changed}.values())

    def delta(self, now_s: float) -> WorldDelta | None:
        """What changed since the last delta, or None."""
        objects = tuple(show(thing, now_s) for thing in self.settle(now_s))
        removed, self.things.removed = tuple(self.things.removed), []
        robots, areas = self.fleet.changes(), self.areas.changes()
        if not (objects or removed or robots or areas):
            return None
        self.seq += 1
        return WorldDelta(seq=self.seq, stamp_s=now_s, robots=robots, objects=objects, areas=areas, removed=removed)

    def snapshot(self, now_s: float) -> WorldState:
        """All of W as last told in deltas."""
        return WorldState(
            seq=self.seq,
            stamp_s=now_s,
            robots=self.fleet.states(),
            objects=tuple(state(t, now_s) for t in self.things if t.shown >= 0),
            areas=self.areas.states(),
        )

    def _review(self, thing: Thing, now_s: float) -> None:
        if abs(thing.x - thing.placed_x) + abs(thing.y - thing.placed_y) + abs(thing.z - thing.placed_z) > _PLACED_M:
            self._locate(thing)
        for name, fact in thing.facts.items():
            before = fact.value
            if settle(fact, now_s, self.trust, self._robots):
                thing.version += 1
                if name == "isOpen" and fact.value != before:
                    self._locks_due = True
                    self._relocate_near(thing)

    def _locate(self, thing: Thing) -> None:
        """Room and parent from the believed place, for what nobody has put there knowingly."""
        self.things.settle(thing)
        far = abs(thing.x - thing.placed_x) + abs(thing.y - thing.placed_y) > _RESETTLED_M
        thing.placed_x, thing.placed_y, thing.placed_z = thing.x, thing.y, thing.z
        room = self.floor.room_at(thing.x, thing.y)
        shut_in = thing.locked or hidden(thing, self.things)
        parent = thing.receptacle if shut_in else parent_of(thing, self.things)
        if room != thing.room or parent != thing.receptacle:
            thing.room, thing.receptacle = room, parent
            thing.version += 1
            if self.things.inside(thing):
                self._locks_due = True  # what is in it may be shut in with it
            else:
                self._lock(thing)
        if far and thing.shape.receptacle_mode is not None:
            self._relocate_near(thing)

    def _relocate_near(self, thing: Thing) -> None:
        """What was, or may now be, in or on it is placed anew with the next delta."""
        reach_m = FARTHEST * thing.shape.half_diagonal_m + _RESETTLED_M
        largest_m = thing.shape.half_diagonal_m / LEAST_HOLDER
        near = self.things.near(thing.x, thing.y, reach_m)
        maybe = [
            o for o in near
            if o.shape.half_diagonal_m <= largest_m and hypot(o.x - thing.x, o.y - thing.y) < reach_m
        ]  # fmt: skip
        for other in (*maybe, *self.things.inside(thing)):
            if other is not thing and other.shape.kind != "static" and not other.locked:
                other.placed_z = 1e9  # by the height, which does not pass it on to yet others
                self.things.touch(other)

    def lock(self) -> None:
        """Mark what is in hands or behind doors."""
        self._locks_due = False
        for thing in self.things:
            self._lock(thing)

    def _lock(self, thing: Thing) -> None:
        locked = thing.receptacle in self.fleet.robots or hidden(thing, self.things)
        if locked != thing.locked:
            thing.locked = locked
            self.things.touch(thing)

    def upkeep(self, now_s: float) -> None:
        """What can wait until readers have their delta: two records of one thing, and what fades with age.

        The next delta tells what it changed.
        """
        if now_s - self._merged_s >= _MERGE_S:
            self._merged_s = now_s
            changed, self._unmerged = self._unmerged, {}
            for keep, drop in duplicates(self.things, changed):
                self._merge(keep, drop)
        if now_s - self._swept_s >= _SWEEP_S:
            self._swept_s = now_s
            self._sweep(now_s)

    def _sweep(self, now_s: float) -> None:
        for thing in list(self.things):
            if thing.shown < 0 and now_s - thing.stamp_s > _TENTATIVE_S:
                self.things.remove(thing)
                continue
            self._review(thing, now_s)
            if due(thing, now_s):
                self.things.touch(thing)

    def _merge(self, keep: Thing, drop: Thing) -> None:
        """Two records of one thing become one; the surer keeps its id."""
        for source in self.fusion.sources.values():
            for track, thing in source.tracks.items():
                if thing is drop:
                    source.tracks[track] = keep
        for id, sight in drop.sights.items():
            if id not in keep.sights:
                keep.sights[id] = sight
                keep.belief += sight.support  # a source that saw both counts once
        for name, fact in drop.facts.items():
            for id, said in fact.claims.items():
                mine = self.property_of(keep, name)
                if id not in mine.claims:
                    claim(mine, id, said.probability, said.stamp_s)
        for type, weight in drop.votes.items():
            keep.votes[type] = keep.votes.get(type, 0.0) + weight
        keep.retype(max(sorted(keep.votes), key=lambda type: keep.votes[type], default=keep.type))
        keep.hits += drop.hits
        keep.verified = keep.verified or drop.verified
        keep.from_above = keep.from_above or drop.from_above
        keep.looked_into = keep.looked_into or drop.looked_into
        keep.version += 1
        self.things.touch(keep)
        for thing in self.things.inside(drop):
            if thing is not keep:
                thing.receptacle = keep.id
                thing.version += 1
                self.things.touch(thing)
        self.things.merged[drop.id] = keep.id
        self.things.remove(drop)
