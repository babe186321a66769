"""Evidence that a thing has gone: said by a source, or not seen where it ought to be. Never from one look alone."""

from collections.abc import Callable
from math import hypot

from hub.fusion import Fusion, Source
from hub.records import Sight, Thing
from wire.messages.observation import Absence, ObservationBatch, View
from wire.outline import inside

_GAP_S = 0.4
"""Looks closer together than this are one look."""
_SAID = {"robot": 0.8, "cctv": 0.5, "device": 1.0}
"""Log-odds taken away by one look whose source says that the thing is gone."""
_UNSEEN = {"robot": 0.35, "cctv": 0.1, "device": 0.0}
"""Log-odds taken away by one look that should have shown it: detectors overlook small things again and again."""
_DEEPEST = {"robot": -4.5, "cctv": -1.6, "device": -2.0}
_DEEPEST_UNSEEN = -1.2
_UNSEEN_WITHIN_M = 1.7
_LATELY_S = 8.0
"""What anybody has seen within this time is not missed by another who looks past it."""
_MARGIN_M = 0.15
_SURE_M2 = 0.25**2
_OVERRIDE_LOOKS = 6
"""After so many close looks in vain, what cameras said before no longer counts."""
_FORGET = -2.2


class Absences:
    """Takes absence out of batches; forgets things nobody believes in any more."""

    def __init__(self, fusion: Fusion, hidden: Callable[[Thing], bool]) -> None:
        self._fusion, self._things, self._hidden = fusion, fusion.things, hidden

    def take(self, batch: ObservationBatch, mark: int) -> None:
        """`mark` is on the things that the same picture showed."""
        source = self._fusion.source(batch.source, batch.kind)
        for absence in batch.gone:
            thing = source.tracks.get(absence.track) or self._nearest(absence)
            if thing is not None and thing.mark != mark and thing.id in self._things.by_id:
                weight = _SAID[batch.kind] * absence.confidence
                self._deny(thing, source, batch.stamp_s, weight, _DEEPEST[batch.kind])
        if batch.view is not None and batch.view.polygon_m:
            self._unseen(batch.view, source, batch.stamp_s, mark)

    def _nearest(self, absence: Absence) -> Thing | None:
        x, y, _ = absence.position_enu_m
        near = [t for t in self._things.near(x, y, 0.6) if t.type == absence.type and hypot(t.x - x, t.y - y) < 0.6]
        return min(near, key=lambda t: (hypot(t.x - x, t.y - y), t.id), default=None)

    def _unseen(self, view: View, source: Source, stamp_s: float, mark: int) -> None:
        """Things that stood in plain view of a source and were not in its picture."""
        x, y, _ = view.origin_enu_m
        reach = min(view.range_m, _UNSEEN_WITHIN_M if source.robot else 8.0)
        near = self._things.near(x, y, reach) if source.robot else source.tracks.values()
        for thing in [t for t in near if t.mark < mark]:
            if not self._expected(thing, view, source, stamp_s, reach):
                continue
            self._deny(thing, source, stamp_s, _UNSEEN[source.kind], _DEEPEST_UNSEEN)

    def _expected(self, thing: Thing, view: View, source: Source, stamp_s: float, reach: float) -> bool:
        """Whether a source that looked this way would surely have noticed the thing."""
        if thing.locked or thing.shape.kind != "pickup" or stamp_s - thing.stamp_s < _LATELY_S:
            return False
        if thing.xx > _SURE_M2 or thing.yy > _SURE_M2:
            return False
        sight = thing.sights.get(source.id)
        if not source.robot and (sight is None or sight.hits < 3):
            return False  # a camera that never saw it there may have something in between
        x, y, _ = view.origin_enu_m
        distance = hypot(thing.x - x, thing.y - y)
        if distance > reach - _MARGIN_M or distance < 0.5:
            return False
        return inside((thing.x, thing.y), view.polygon_m) and inside(_beyond(thing, x, y, distance), view.polygon_m)

    def _deny(self, thing: Thing, source: Source, stamp_s: float, weight: float, deepest: float) -> None:
        if thing.locked or self._hidden(thing):
            return
        sight = thing.sights.get(source.id)
        if sight is None:
            sight = thing.sights[source.id] = Sight(source.robot)
        if stamp_s - sight.absent_s < _GAP_S:
            return
        sight.absent_s = stamp_s
        sight.absent_looks += 1
        after = max(sight.support - weight, min(deepest, sight.support))
        thing.belief += after - sight.support
        sight.support = after
        thing.version += 1
        if source.robot and sight.absent_looks == _OVERRIDE_LOOKS:
            self._override(thing, stamp_s)
        self._things.touch(thing)
        if thing.belief < _FORGET and thing.shape.kind != "static":
            self._things.remove(thing)

    def _override(self, thing: Thing, stamp_s: float) -> None:
        """First-hand sight overrides what cameras had said before it, and counts against them."""
        for id, sight in thing.sights.items():
            if sight.support > 0.0 and not sight.robot:
                if stamp_s - sight.stamp_s < 60.0:
                    self._fusion.trust.score(id, right=False)
                thing.belief -= sight.support
                sight.support = 0.0


def _beyond(thing: Thing, x: float, y: float, distance: float) -> tuple[float, float]:
    """A point just behind the thing: if that is in view too, nothing stands in front of it."""
    reach = (distance + _MARGIN_M) / distance
    return (x + (thing.x - x) * reach, y + (thing.y - y) * reach)
