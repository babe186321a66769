"""F of equation 5 for what is seen: one thing from many looks, first-hand sight before cameras, doubt growing with age.

The loop over a batch is the hub's hottest: a track already bound to a thing is checked and taken in without a search.
"""

from collections.abc import Callable
from math import hypot, inf

from hub import association
from hub.facts import claim
from hub.kinds import shape
from hub.records import Fact, Sight, Thing
from hub.things import Things
from hub.trust import Trust
from wire.messages.observation import ObjectObservation, ObservationBatch
from wire.model import Vec3

CLOSE_M = 2.6
"""A robot nearer than this sees first-hand."""
_FIRST_HAND_S = 30.0
_HEARSAY = 16.0
"""A camera's variances count this much larger while a robot's first-hand sight is fresh."""
_TRACK_GATE = 16.0
_FLOOR_M2 = {"robot": 0.02**2, "cctv": 0.05**2, "device": 0.05**2}
"""Errors of one source repeat from picture to picture: no number of them makes the place surer than this."""
_VOTES = {"robot": 4, "cctv": 8, "device": 8}
"""From one place a source votes this often on a type: more of the same picture is no more evidence."""
_ANOTHER_PLACE_M = 0.3
_MISNAMED = 0.6
"""Part of its half diagonal within which furniture under another name is the same."""
_KNOWN_HITS, _REPEATED, _PLACED_S = 4, 3.0, 1.0
"""One more look at what has been seen this often counts with variances so many times larger, unless it has moved; of
a source that stands still, one a second counts for the place."""
_STEP = {"robot": 1.7, "cctv": 0.8, "device": 2.0}
_CAP = {"robot": 4.2, "cctv": 2.4, "device": 3.0}


class Source:
    """What the fusion remembers of one source."""

    __slots__ = (
        "boot_id",
        "cap",
        "floor_m2",
        "id",
        "kind",
        "origin",
        "place",
        "place_m",
        "robot",
        "step",
        "tracks",
        "votes",
        "weight",
    )

    def __init__(self, id: str, kind: str) -> None:
        self.id, self.kind, self.robot = id, kind, kind == "robot"
        self.tracks: dict[str, Thing] = {}
        self.boot_id = ""
        self.origin: Vec3 | None = None
        """Where a robot looked from in the picture at hand."""
        self.place, self.place_m = 0, (0.0, 0.0)
        """Counts the places from which it has looked; where it came to the present one."""
        self.floor_m2, self.step, self.cap, self.votes = _FLOOR_M2[kind], _STEP[kind], _CAP[kind], _VOTES[kind]
        self.weight = 3.0 if self.robot else 1.0

    def look_from(self, origin: Vec3 | None) -> None:
        """Note where a robot looks from in the picture at hand; None when it is not known."""
        self.origin = origin
        if origin is not None and hypot(origin[0] - self.place_m[0], origin[1] - self.place_m[1]) > _ANOTHER_PLACE_M:
            self.place, self.place_m = self.place + 1, (origin[0], origin[1])


class Fusion:
    """Takes batches into a set of things."""

    def __init__(self, things: Things, trust: Trust, robot_near: Callable[[Vec3], bool]) -> None:
        self.things, self.trust = things, trust
        self.sources: dict[str, Source] = {}
        self._robot_near = robot_near
        self._mark = 0

    def source(self, id: str, kind: str) -> Source:
        known = self.sources.get(id)
        if known is None:
            known = self.sources[id] = Source(id, kind)
        return known

    def take(self, batch: ObservationBatch) -> int:
        """Take one picture in; returns the mark that the things seen in it now carry."""
        source = self.source(batch.source, batch.kind)
        if source.boot_id != batch.boot_id:
            source.boot_id = batch.boot_id
            source.tracks.clear()  # a restarted source begins its names anew
        self._mark = mark = self._mark + 1
        stamp_s = batch.stamp_s
        source.look_from(batch.view.origin_enu_m if batch.view is not None and source.robot else None)
        late: list[ObjectObservation] = []
        tracks, refine = source.tracks, self._refine
        for seen in batch.objects:
            thing = tracks.get(seen.track)
            if thing is None or thing.mark >= mark or not refine(thing, seen, source, stamp_s, mark):
                late.append(seen)
        for seen in sorted(late, key=lambda s: -s.confidence) if late else ():
            self._associate(seen, source, stamp_s, mark)
        if len(tracks) > 2000:
            source.tracks = {track: thing for track, thing in tracks.items() if thing.id in self.things.by_id}
        return mark

    def _associate(self, seen: ObjectObservation, source: Source, stamp_s: float, mark: int) -> None:
        thing = association.find(self.things, seen, source.id, stamp_s, mark)
        former = source.tracks.get(seen.track)
        if thing is None and former is not None and former.mark < mark and self._moved(former, seen):
            thing = former
            _restart(thing, seen)
            self.things.settle(thing)
        if thing is None:
            if self._robot_near(seen.position_enu_m):
                return  # part of a robot, or what it carries, taken for something new
            thing = self.things.new(seen.type, seen.position_enu_m, stamp_s)
            _restart(thing, seen)
        source.tracks[seen.track] = thing
        self._refine(thing, seen, source, stamp_s, mark, gate=inf)

    def _moved(self, thing: Thing, seen: ObjectObservation) -> bool:
        """Whether a source's lasting track says that a thing has moved by itself (or was carried by somebody)."""
        return (
            thing.id in self.things.by_id
            and not thing.locked
            and thing.type == seen.type
            and thing.shape.kind != "static"
            and seen.confidence >= 0.5
        )

    def _refine(
        self,
        thing: Thing,
        seen: ObjectObservation,
        source: Source,
        stamp_s: float,
        mark: int,
        gate: float = _TRACK_GATE,
    ) -> bool:
        """Inverse-covariance fusion of one look (a Kalman step); False when it cannot be of this thing."""
        x, y, z = seen.position_enu_m
        rxx, rxy, ryy, rzz = seen.covariance_m2
        known = thing.shape
        type_same = seen.type == thing.type
        if not type_same and gate != inf and seen.type not in known.confusable:
            return self._misnamed(thing, seen, source, stamp_s, mark)
        if thing.locked:
            return self._absorb(thing, x, y, mark, gate)
        grown = known.walk_m2_per_s * (stamp_s - thing.stamp_s) if stamp_s > thing.stamp_s else 0.0
        floor = source.floor_m2
        pxx, pxy, pyy, pzz = thing.xx + grown, thing.xy, thing.yy + grown, thing.zz + grown
        dx, dy, dz = x - thing.x, y - thing.y, z - thing.z
        rxx, ryy, rzz = rxx + floor, ryy + floor, rzz + floor
        sxx, sxy, syy = pxx + rxx, pxy + rxy, pyy + ryy
        wxx, wyy = sxx + known.gate_m2, syy + known.gate_m2
        if wyy * dx * dx - 2.0 * sxy * dx * dy + wxx * dy * dy > gate * (wxx * wyy - sxy * sxy):
            return False
        sight = thing.sights.get(source.id)
        if sight is None:
            sight = thing.sights[source.id] = Sight(source.robot)
        if thing.hits > _KNOWN_HITS and dx * dx + dy * dy < 4.0 * rxx:
            if not source.robot and stamp_s - sight.placed_s < _PLACED_S:
                return self._note(thing, seen, sight, source, stamp_s, mark)
            rxx, rxy, ryy, rzz = _REPEATED * rxx, _REPEATED * rxy, _REPEATED * ryy, _REPEATED * rzz
            sxx, sxy, syy = pxx + rxx, pxy + rxy, pyy + ryy
        sight.placed_s = stamp_s
        if source.robot:
            if stamp_s - thing.first_hand_s > _FIRST_HAND_S:
                pxx, pyy, pzz = max(pxx, 4.0 * rxx), max(pyy, 4.0 * ryy), max(pzz, 4.0 * rzz)
                sxx, syy = pxx + rxx, pyy + ryy
            self._first_hand(thing, seen, stamp_s, source.origin)
        elif stamp_s - thing.first_hand_s < _FIRST_HAND_S:
            rxx, rxy, ryy, rzz = _HEARSAY * rxx, _HEARSAY * rxy, _HEARSAY * ryy, _HEARSAY * rzz
            sxx, sxy, syy = pxx + rxx, pxy + rxy, pyy + ryy
        det = sxx * syy - sxy * sxy
        a, b = (pxx * syy - pxy * sxy) / det, (pxy * sxx - pxx * sxy) / det
        c, d = (pxy * syy - pyy * sxy) / det, (pyy * sxx - pxy * sxy) / det
        thing.x += a * dx + b * dy
        thing.y += c * dx + d * dy
        pxx, pxy, pyy = pxx - a * pxx - b * pxy, pxy - a * pxy - b * pyy, pyy - c * pxy - d * pyy
        thing.xx = pxx if pxx > floor else floor
        thing.xy = pxy
        thing.yy = pyy if pyy > floor else floor
        k = pzz / (pzz + rzz)
        thing.z += k * dz
        pzz -= k * pzz
        thing.zz = pzz if pzz > floor else floor
        return self._note(thing, seen, sight, source, stamp_s, mark)

    def _note(
        self, thing: Thing, seen: ObjectObservation, sight: Sight, source: Source, stamp_s: float, mark: int
    ) -> bool:
        """That it was seen, and what was seen of it besides its place."""
        self._credit(thing, seen, sight, source, stamp_s)
        thing.mark = mark
        if stamp_s >= thing.stamp_s:
            thing.stamp_s = stamp_s
            thing.last_source = source.id
        if not thing.touched:
            thing.touched = True
            self.things.touched.append(thing)
        return True

    def _misnamed(self, thing: Thing, seen: ObjectObservation, source: Source, stamp_s: float, mark: int) -> bool:
        """Furniture that a source calls by another name: it counts as seen and votes, but its place is another's."""
        if "pickup" in (thing.shape.kind, shape(seen.type).kind):
            return False
        x, y, _ = seen.position_enu_m
        if (x - thing.x) ** 2 + (y - thing.y) ** 2 > (_MISNAMED * thing.shape.half_diagonal_m) ** 2:
            return False
        sight = thing.sights.setdefault(source.id, Sight(source.robot))
        return self._note(thing, seen, sight, source, stamp_s, mark)

    def _absorb(self, thing: Thing, x: float, y: float, mark: int, gate: float) -> bool:
        """A sight of something in a hand or behind a door: it is that thing, and says nothing new."""
        if (x - thing.x) ** 2 + (y - thing.y) ** 2 > gate * association.LOCKED_M2:
            return False
        thing.mark = mark
        return True

    def _credit(self, thing: Thing, seen: ObjectObservation, sight: Sight, source: Source, stamp_s: float) -> None:
        """Existence, type and properties."""
        confidence = seen.confidence
        sight.confidence, sight.stamp_s = confidence, stamp_s
        sight.x, sight.y, sight.z = seen.position_enu_m
        sight.hits += 1
        sight.absent_looks = 0
        thing.hits += 1
        if sight.support < source.cap:
            self._support(thing, sight, source, confidence)
        if sight.place != source.place:
            sight.place, sight.votes = source.place, 0
        if sight.votes < source.votes:
            sight.votes += 1
            self._vote(thing, seen.type, confidence * source.weight)
        facts, id = thing.facts, source.id
        for name, probability in seen.props.items():
            fact = facts.get(name)
            if fact is None:
                fact = facts[name] = Fact()
            claim(fact, id, probability, stamp_s)

    def _support(self, thing: Thing, sight: Sight, source: Source, confidence: float) -> None:
        cap = source.cap
        if not source.robot:
            cap *= min(max(self.trust.odds(source.id) / _USUAL_ODDS, 0.15), 1.3)
        after = min(sight.support + source.step * confidence, max(cap, sight.support))
        thing.belief += after - sight.support
        sight.support = after

    def _vote(self, thing: Thing, type: str, weight: float) -> None:
        votes = thing.votes
        votes[type] = total = votes.get(type, 0.0) + weight
        if type != thing.type and total > votes.get(thing.type, 0.0):
            thing.retype(type)
            thing.version += 1

    def _first_hand(self, thing: Thing, seen: ObjectObservation, stamp_s: float, origin: Vec3 | None) -> None:
        if origin is None or seen.confidence < 0.5:
            return
        x, y, _ = seen.position_enu_m
        if (x - origin[0]) ** 2 + (y - origin[1]) ** 2 > (CLOSE_M + thing.shape.half_diagonal_m) ** 2:
            return
        if stamp_s - thing.first_hand_s > _FIRST_HAND_S:
            self._judge(thing, stamp_s)
        thing.first_hand_s = stamp_s
        if not thing.verified:
            thing.verified = True
            thing.version += 1

    def _judge(self, thing: Thing, stamp_s: float) -> None:
        """A robot confirms what others had claimed lately."""
        for id, sight in thing.sights.items():
            if not sight.robot and sight.support > 0.0 and stamp_s - sight.stamp_s < _FIRST_HAND_S:
                self.trust.score(id, right=True)


def _restart(thing: Thing, seen: ObjectObservation) -> None:
    """Begin the place of a thing anew from one look."""
    thing.x, thing.y, thing.z = seen.position_enu_m
    thing.xx, thing.xy, thing.yy, thing.zz = (9.0 * v for v in seen.covariance_m2)


_USUAL_ODDS = 1.386
"""Log-odds of a source nobody has judged yet."""
