"""Sightings of many pictures to things that have names: association, confirmation, and evidence that one has gone."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import log, sqrt

import numpy as np

from devices.vision import layout
from devices.vision.look import Seen
from devices.vision.opinion import compare
from devices.vision.projection import Sighting
from devices.vision.track import Track
from devices.vision.visibility import should_be_visible
from wire.messages.observation import Absence, ObjectObservation

GATE_SIGMAS = 3.0
GATE_FLOOR_M = 0.15
MAX_GATE_M = 1.2
TYPE_WEIGHT = 0.6
MIN_TYPE_AGREEMENT = -6.0
"""Log of the least overlap of two type distributions that can be one thing."""
GONE_CONFIDENCE = 0.98
MIN_MISSES = 3
FORGET_S = 120.0
"""A thing out of view is remembered this long under its name."""


@dataclass(frozen=True)
class Change:
    """Something that a person would note: `what` is appeared, gone, or a property's name."""

    what: str
    track: Track
    value: bool = True


@dataclass(frozen=True)
class Tracked:
    """What the tracker makes of one picture."""

    objects: tuple[ObjectObservation, ...] = ()
    """Confirmed things seen in this picture."""
    gone: tuple[Absence, ...] = ()
    """Confirmed things that should have been seen in this picture and the last few and were not."""
    changes: tuple[Change, ...] = ()


@dataclass
class Tracker:
    """The memory of one camera, fixed or moving."""

    tracks: list[Track] = field(default_factory=list)
    _count: int = 0
    _said: dict[tuple[str, str], bool] = field(default_factory=dict)

    def update(self, seen: Seen) -> Tracked:
        """Take in one picture."""
        matched = associate(self.tracks, seen.sightings)
        for index, number in matched.items():
            track = self.tracks[number]
            if track.eye != "embedded":
                track.adopt(seen.sightings[index])
            track.see(seen.sightings[index], seen.stamp_s)
        return self._tell(matched, [s for i, s in enumerate(seen.sightings) if i not in matched], seen)

    def take_opinion(self, seen: Seen) -> Tracked:
        """Take in what a vision model saw, perhaps a while ago: what the detector knows becomes surer, the rest is new.

        What is told of it are the things that the model alone has seen.
        """
        opinion = compare(self.tracks, seen)
        for index, number in opinion.agreed.items():
            track = self.tracks[number]
            if track.eye == seen.eye:
                track.see(seen.sightings[index], seen.stamp_s)
            else:
                track.second(seen.sightings[index])
        return self._tell(opinion.agreed, [seen.sightings[i] for i in opinion.new], seen)

    def _tell(self, matched: dict[int, int], new: Sequence[Sighting], seen: Seen) -> Tracked:
        """Who missed a thing is only who has seen it before; and each eye tells of its own things."""
        hit = set(matched.values())
        unseen = [t for i, t in enumerate(self.tracks) if i not in hit and t.eye == seen.eye]
        current = [self.tracks[i] for i in sorted(hit) if self.tracks[i].eye == seen.eye]
        gone = self._miss(unseen, seen)
        current += self._begin(new, seen)
        told = [t for t in current if t.confirmed and t.type != layout.ROBOT]
        changes = self._changes(told) + [Change("gone", t) for t in gone]
        return Tracked(tuple(t.observation() for t in told), tuple(_absence(t) for t in gone), tuple(changes))

    def _begin(self, sightings: Sequence[Sighting], seen: Seen) -> list[Track]:
        started = []
        for sighting in sightings:
            self._count += 1
            started.append(Track(f"t{self._count}", sighting, seen.stamp_s, seen.eye))
        self.tracks += started
        return started

    def _miss(self, unseen: list[Track], seen: Seen) -> list[Track]:
        """Count misses of what should be visible; forget what is gone, unconfirmed or long out of sight."""
        gone, dropped = [], []
        for track in unseen:
            if not should_be_visible(track, seen):
                if seen.stamp_s - track.stamp_s > FORGET_S:
                    dropped.append(track)
                continue
            track.known += 1
            track.misses += 1
            if not track.confirmed:
                dropped.extend([track] if track.misses >= 2 else [])
            elif track.misses >= MIN_MISSES and _absence(track).confidence >= GONE_CONFIDENCE:
                dropped.append(track)
                gone.append(track)
        self.tracks = [t for t in self.tracks if t not in dropped]
        return [t for t in gone if t.type != layout.ROBOT]

    def _changes(self, told: list[Track]) -> list[Change]:
        changes = []
        for track in told:
            if self._say(track, "appeared", True):
                changes.append(Change("appeared", track))
            for prop, probability in track.props().items():
                if not 0.2 < probability < 0.8 and self._say(track, prop, probability > 0.5):
                    changes.append(Change(prop, track, probability > 0.5))
        return changes

    def _say(self, track: Track, what: str, value: bool) -> bool:
        """Whether this is news: a property's first value is not a change."""
        key = (track.name, what)
        before = self._said.get(key)
        self._said[key] = value
        return before is None if what == "appeared" else before is not None and before != value


def associate(tracks: Sequence[Track], sightings: Sequence[Sighting]) -> dict[int, int]:
    """Sighting number -> track number, nearest pairs first, each used once."""
    if not tracks or not sightings:
        return {}
    seen_m = np.array([s.position_enu_m[:2] for s in sightings])
    known_m = np.array([t.position[:2] for t in tracks])
    near = ((seen_m[:, None] - known_m[None]) ** 2).sum(axis=2) <= MAX_GATE_M**2
    pairs = []
    for i, j in np.argwhere(near).tolist():
        cost = pair_cost(tracks[j], sightings[i])
        if cost is not None:
            pairs.append((cost, i, j))
    matched: dict[int, int] = {}
    used: set[int] = set()
    for _, i, j in sorted(pairs):
        if i not in matched and j not in used:
            matched[i] = j
            used.add(j)
    return matched


def pair_cost(track: Track, sighting: Sighting) -> float | None:
    """How badly a sighting fits a track: distance in gates plus disagreement on the type; None when it cannot be."""
    dx, dy, dz = (a - b for a, b in zip(sighting.position_enu_m, track.position_enu_m, strict=True))
    xx, xy, yy, zz = (a + b for a, b in zip(sighting.covariance_m2, track.covariance_m2, strict=True))
    floor = GATE_FLOOR_M**2
    xx, yy, zz = xx + floor, yy + floor, zz + floor
    determinant = xx * yy - xy * xy
    distance2 = (yy * dx * dx - 2.0 * xy * dx * dy + xx * dy * dy) / determinant + dz * dz / zz
    if distance2 > GATE_SIGMAS**2:
        return None
    agreement = type_agreement(track, sighting)
    if agreement < MIN_TYPE_AGREEMENT:
        return None
    return sqrt(distance2) - TYPE_WEIGHT * agreement


def type_agreement(track: Track, sighting: Sighting) -> float:
    """Log of the probability that track and sighting are of one type, were their opinions independent."""
    log_probs = sighting.detection.log_probs
    return log(max(1e-9, float(track.type_probabilities[: len(log_probs)] @ np.exp(log_probs))))


def _absence(track: Track) -> Absence:
    return Absence(
        track=track.name,
        type=track.type,
        position_enu_m=track.position_enu_m,
        confidence=float(1.0 - track.miss_probability**track.misses),
    )
