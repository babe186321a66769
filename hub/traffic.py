"""Who may be where: robots neither collide nor block each other in doors.

One order of precedence at a time: who is in or has claimed a door, then who set out first. The foremost always goes;
everybody else stands before coming into its way, and steps aside when already in it. An order has no circles, and
whoever arrives gives up its place, so nobody waits for ever.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from math import hypot

from hub.floor import Doorway, FloorPlan
from hub.movers import Mover, Ruling, share_height
from hub.parking import Parking, Way
from hub.ways import cut, path_to_path_m, point_to_path_m
from wire.model import Vec2

_MARGIN_M = 0.12
_ZONE_M = 0.75
"""Around the middle of a door: one robot at a time."""
_CLAIM_M = 2.0
_STOP_M = 0.7
"""A robot stands when the next stretch of its path comes into somebody's way."""
_AHEAD_M = 2.6
"""This much of a path is kept clear for the one that goes first."""
_HARD_AHEAD_M = 0.35
_SWEPT_M = 0.2
_SPOT_M = 0.6
"""A way that ends this near to the place to step aside to leads there."""
_REST_S = 1.0
_SWAP_S = 4.0
_STIR_M = 0.1
_STUCK_S, _STILL_S = 5.0, 3.0
_REIGN_S = 6.0


@dataclass
class _Ticket:
    number: int
    until_s: float
    promoted_s: float = -1e9


@dataclass
class Traffic:
    """Keeps precedence, door claims and step-aside places from one look to the next."""

    floor: FloorPlan
    blocked: Callable[[Vec2, float], bool]
    """Whether a body of some radius would touch known furniture at a place."""
    _tickets: dict[str, _Ticket] = field(default_factory=dict)
    _next: int = 0
    _claims: dict[str, str] = field(default_factory=dict)
    _aside: dict[str, Vec2] = field(default_factory=dict)
    _moved: dict[str, tuple[Vec2, float]] = field(default_factory=dict)
    """Where each robot was when it last moved or wanted nothing, and when that was."""
    _supreme: str | None = None
    _supreme_s: float = 0.0
    _reigns: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._held_by: dict[str, str] = {}
        """Who waited for whom at the last look."""
        self._moves: dict[str, list[Vec2]] = {}
        """What each robot sweeps until the next look, of those already told."""
        self._pleas: dict[str, Mover] = {}
        """By one that wants nothing: for whom it makes room, with the way that this one would go then."""
        self._boxed_in: set[str] = set()  # who found nowhere to step aside to at this look
        self._parking = Parking(self.floor, self.blocked)

    def rule(self, movers: Sequence[Mover], now_s: float) -> dict[str, Ruling]:
        """Orders for everybody."""
        for mover in movers:
            self._parking.tread(mover.position_m)
            self._ticket(mover, now_s)
            self._watch(mover, now_s)
        self._crown(movers, now_s)
        self._claim(movers)
        order = sorted(movers, key=lambda m: self._rank(m))
        rulings: dict[str, Ruling] = {}
        self._moves = {m.id: [m.position_m] for m in movers}
        self._boxed_in = set()
        for index, mover in enumerate(order):
            before = [m for m in order[:index] if share_height(m, mover)]
            before += [self._pleas[mover.id]] if mover.id in self._pleas else []
            met = [m for m in movers if share_height(m, mover)]
            ruling = rulings[mover.id] = self._rule_one(mover, before, met, now_s)
            if ruling.go:
                way = mover.way if ruling.step_aside_m is None else _way_aside(mover, ruling.step_aside_m)
                self._moves[mover.id] = cut(way, _SWEPT_M)
        self._pleas = {id: plea for id, plea in self._pleas.items() if plea.id in self._boxed_in}
        self._held_by = {id: ruling.held_by for id, ruling in rulings.items() if not ruling.go and ruling.held_by}
        return rulings

    def _ticket(self, mover: Mover, now_s: float) -> None:
        """A number drawn on setting out, given up after a rest."""
        ticket = self._tickets.get(mover.id)
        if mover.path_m:
            if ticket is None:
                self._next += 1
                ticket = self._tickets[mover.id] = _Ticket(self._next, now_s)
            ticket.until_s = now_s + _REST_S
        elif ticket is not None and now_s > ticket.until_s and mover.id not in self._aside:
            del self._tickets[mover.id]

    def _watch(self, mover: Mover, now_s: float) -> None:
        last = self._moved.get(mover.id)
        if last is None or not mover.path_m or _apart_m(last[0], mover.position_m) > _STIR_M:
            self._moved[mover.id] = (mover.position_m, now_s)

    def _crown(self, movers: Sequence[Mover], now_s: float) -> None:
        """Whoever has waited too long goes before everybody, in turn: no knot holds for ever."""
        by_id = {m.id: m for m in movers}
        stuck = [m for m in movers if self._is_knotted(m, by_id, now_s)]
        reigning = next((m for m in movers if m.id == self._supreme and m.path_m), None)
        if reigning is not None and now_s - max(self._supreme_s, self._moved[reigning.id][1]) < _REIGN_S:
            return
        self._supreme = None
        if stuck:
            heir = min(stuck, key=lambda m: (self._reigns.get(m.id, 0), self._rank(m)))
            self._supreme, self._supreme_s = heir.id, now_s
            self._reigns[heir.id] = self._reigns.get(heir.id, 0) + 1

    def _is_knotted(self, mover: Mover, by_id: dict[str, Mover], now_s: float) -> bool:
        """Whether a robot has waited long, and in the end for one that stands: a queue that moves on is no knot."""
        here, patience_s = mover, _STUCK_S
        for _ in by_id:
            if here.path_m and now_s - self._moved[here.id][1] <= patience_s:
                return False
            holder = by_id.get(self._held_by.get(here.id, ""))
            if holder is None:
                break
            here, patience_s = holder, _STILL_S
        return bool(mover.path_m)

    def _rank(self, mover: Mover) -> tuple[bool, bool, bool, int, str]:
        """Smaller goes first."""
        ticket = self._tickets.get(mover.id)
        in_door = mover.id in self._claims.values() and mover.id not in self._aside  # who makes way goes after
        number = ticket.number if ticket is not None else 0
        return (mover.id != self._supreme, ticket is None, not in_door, number, mover.id)

    def _claim(self, movers: Sequence[Mover]) -> None:
        """Doors belong to who is in them, else to who comes first and asks."""
        by_id = {m.id: m for m in movers}
        for door in self.floor.doors:
            holder = by_id.get(self._claims.get(door.id, ""))
            ruler = by_id.get(self._supreme or "")
            if ruler is not None and _heads_for(ruler, door):
                self._claims[door.id] = ruler.id
                continue
            if holder is not None and (_in_zone(holder, door) or _heads_for(holder, door)):
                continue
            self._claims.pop(door.id, None)
            inside = sorted((m for m in movers if _in_zone(m, door)), key=lambda m: self._rank(m))
            wanting = [m for m in movers if _heads_for(m, door)]
            nearest = sorted(wanting, key=lambda m: (_away_m(m, door), self._rank(m)))
            taker = next(iter([*inside, *nearest]), None)
            if taker is not None:
                self._claims[door.id] = taker.id

    def _rule_one(self, mover: Mover, before: Sequence[Mover], movers: Sequence[Mover], now_s: float) -> Ruling:
        for first in before:
            if first.path_m and self._in_way(mover, first):
                return self._make_way(mover, first, before, movers, now_s)
        if self._aside.pop(mover.id, None) is not None:
            return Ruling(go=False, because="the way is free again")  # its path is still the one aside
        if not mover.path_m:
            return Ruling(go=True)
        near = cut(mover.way, _STOP_M)
        for door in self.floor.doors:
            owner = self._claims.get(door.id)
            if owner not in (None, mover.id) and not _in_zone(mover, door) and _enters(near, door):
                return Ruling(go=False, because=f"{owner} is in {door.id}", held_by=owner or "")
        for first in before:
            if first.path_m and self._comes_into(near, mover, first):
                return Ruling(go=False, because=f"{first.id} goes first", held_by=first.id)
        bumped = self._bumps(mover, mover.way, movers)
        return Ruling(go=True) if bumped is None else Ruling(False, because=f"{bumped} is in front", held_by=bumped)

    def _in_way(self, mover: Mover, first: Mover) -> bool:
        """Whether a robot, where it is, keeps another from its path."""
        clear = mover.radius_m + first.radius_m + _MARGIN_M
        ahead = cut(first.way, _AHEAD_M)
        nearest = point_to_path_m(mover.position_m, ahead)
        if nearest >= clear:
            return mover.id in self._aside and point_to_path_m(mover.position_m, cut(first.way, 2 * _AHEAD_M)) < clear
        if nearest > _apart_m(mover.position_m, first.position_m) - 0.01:
            return False  # beside or behind it: the way leads away
        return mover.id in self._aside or first.id == self._supreme or not _leads_away(mover, first, clear)

    def _comes_into(self, near: list[Vec2], mover: Mover, first: Mover) -> bool:
        clear = mover.radius_m + first.radius_m + _MARGIN_M
        ahead = cut(first.way, _AHEAD_M)
        return path_to_path_m(near[1:] or near, ahead) < clear and not _leads_away(mover, first, clear)

    def _make_way(
        self, mover: Mover, first: Mover, before: Sequence[Mover], movers: Sequence[Mover], now_s: float
    ) -> Ruling:
        others = [m for m in movers if m.id != mover.id]
        kept = self._aside.get(mover.id)
        ways = [(m, cut(m.way, 2 * _AHEAD_M)) for m in before if m.path_m]
        spot = kept if kept is not None and self._parking.good(kept, mover, ways, others) else None
        if spot is None or self._stands_before(mover, spot, movers, now_s):
            spot = self._parking.find(mover, ways, others)
        if spot is None:
            self._swap(mover, first, now_s)
            self._plead(mover, ways, others)
            self._aside.pop(mover.id, None)
            return Ruling(go=False, because=f"in the way of {first.id}, with nowhere to go", held_by=first.id)
        self._aside[mover.id] = spot
        if (bumped := self._bumps(mover, _way_aside(mover, spot), movers)) is not None:
            because = f"{bumped} is in front of the place to step aside to"
            return Ruling(go=False, because=because, held_by=bumped)
        return Ruling(go=True, step_aside_m=spot, because=f"in the way of {first.id}")

    def _stands_before(self, mover: Mover, spot: Vec2, movers: Sequence[Mover], now_s: float) -> bool:
        """Whether somebody has come to stand on the way to a place to step aside to."""
        bumped = self._bumps(mover, _way_aside(mover, spot), movers)
        return any(m.id == bumped and (not m.path_m or now_s - self._moved[m.id][1] > _STILL_S) for m in movers)

    def _plead(self, mover: Mover, ways: Sequence[Way], others: Sequence[Mover]) -> None:
        """Have one that wants nothing make room for one that has nowhere to go."""
        self._boxed_in.add(mover.id)
        if any(plea.id == mover.id for plea in self._pleas.values()):
            return
        resting = [m for m in others if not m.path_m and m.id not in self._pleas]
        for idle in sorted(resting, key=lambda m: (_apart_m(m.position_m, mover.position_m), m.id)):
            rest = [m for m in others if m.id != idle.id]
            spot = self._parking.find(mover, ways, rest)
            if spot is None:
                continue
            plea = replace(mover, path_m=(spot,))
            if self._parking.find(idle, [*ways, (plea, plea.way)], [*rest, mover]) is not None:
                self._pleas[idle.id] = plea
                return

    def _swap(self, mover: Mover, first: Mover, now_s: float) -> None:
        """Nowhere to step aside: let the boxed-in one go first for a while."""
        mine, other = self._tickets.get(mover.id), self._tickets.get(first.id)
        if mine is None or other is None or now_s - max(mine.promoted_s, other.promoted_s) < _SWAP_S:
            return
        mine.number, other.number = min(mine.number, other.number), max(mine.number, other.number)
        mine.promoted_s = other.promoted_s = now_s
        for door, owner in list(self._claims.items()):
            if owner == first.id:
                self._claims[door] = mover.id

    def _bumps(self, mover: Mover, way_m: Sequence[Vec2], movers: Sequence[Mover]) -> str | None:
        """Who would be touched by the next short stretch."""
        step, swept = cut(way_m, _HARD_AHEAD_M), cut(way_m, _SWEPT_M)
        for other in movers:
            if other.id == mover.id:
                continue
            close = mover.radius_m + other.radius_m + 0.05
            apart = _apart_m(mover.position_m, other.position_m)
            nearest = min(point_to_path_m(other.position_m, step), path_to_path_m(swept, self._moves[other.id]))
            if nearest < close and nearest < apart - 0.01:
                return other.id
        return None


def _leads_away(mover: Mover, first: Mover, clear_m: float) -> bool:
    """Whether a robot walks ahead of another, the same way, and will be gone before it comes."""
    if not mover.path_m:
        return False
    mine = cut(mover.way, 1.0)
    gap = _apart_m(mover.position_m, first.position_m)
    further = _apart_m(mine[-1], first.position_m)
    return further > gap + 0.5 and gap > 0.6 * clear_m


def _way_aside(mover: Mover, spot: Vec2) -> list[Vec2]:
    """The way that a robot has found to a place to step aside to, or the straight one until it tells."""
    return mover.way if mover.path_m and _apart_m(mover.path_m[-1], spot) < _SPOT_M else [mover.position_m, spot]


def _away_m(mover: Mover, door: Doorway) -> float:
    return _apart_m(mover.position_m, door.middle_m)


def _apart_m(a: Vec2, b: Vec2) -> float:
    return hypot(a[0] - b[0], a[1] - b[1])


def _in_zone(mover: Mover, door: Doorway) -> bool:
    return _away_m(mover, door) < _ZONE_M


def _heads_for(mover: Mover, door: Doorway) -> bool:
    return bool(mover.path_m) and _enters(cut(mover.way, _CLAIM_M), door)


def _enters(path_m: Sequence[Vec2], door: Doorway) -> bool:
    """Whether a path goes through a door, not merely past it."""
    normal, middle = door.normal, door.middle_m
    sides = [(p[0] - middle[0]) * normal[0] + (p[1] - middle[1]) * normal[1] for p in path_m]
    if point_to_path_m(middle, path_m) > door.width_m / 2.0 + 0.2:
        return False
    return min(sides) < 0.25 and max(sides) > -0.25
