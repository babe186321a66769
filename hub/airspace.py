"""Who may be where in the air: what flies neither meets nor is over another by accident, nor comes down on anybody.

Who flies where others fly has a level of its own to travel at. Robots whose ways are well over each other do not know
of each other; all others keep to the rules of the floor (`hub.traffic`), with more room around each, and go through a
door one at a time. In a column, straight up or down, there is one at a time, too.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import dist

from hub.floor import FloorPlan
from hub.movers import KEPT_M, Mover, Ruling
from hub.parking import Parking
from hub.traffic import Traffic
from hub.ways import cut, point_to_path_m
from wire.model import Vec2, Vec3

LOW_M = 1.4
"""What flies lower than this is among the robots on the floor: they reach that high with their masts."""
SEPARATION_M = 0.6
"""From one level to the next."""
AROUND_M = 0.08
"""A robot in the air drifts: this much is added to its body."""
_MARGIN_M = 0.12
"""Left between two bodies, drift and all."""
_AHEAD_M = 6.0
"""Heights farther ahead on a way do not matter yet."""
_COLUMN_AHEAD_M = 2.6
"""Who is farther from a column on its way is not there before somebody has gone up or down in it."""
_DOOR_M = 0.75
"""Nearer to its middle one stands in a door."""
_HOME_M = 0.4
"""Who comes down as near as this to where it stood comes down there: good enough before, good enough now."""
_FREE_MPS = 0.15
"""Faster up or down than this it is rising or sinking, which ends by itself."""


@dataclass(frozen=True, slots=True)
class Flyer:
    """What can fly, in the air or on the floor. `path_m` is empty when it wants nothing or only goes up or down."""

    id: str
    position_m: Vec3
    path_m: tuple[Vec3, ...]
    airborne: bool
    busy: bool = False
    """It has a goal."""
    climb_mps: float = 0.0
    home_m: Vec2 | None = None
    """Where it last stood."""
    radius_m: float = 0.3
    heights_known: bool = True

    @property
    def xy(self) -> Vec2:
        return self.position_m[:2]

    @property
    def rising(self) -> bool:
        """Up or down by a skill that tells of no way: so is who has something to do and is just off the floor."""
        return not self.path_m and (abs(self.climb_mps) > _FREE_MPS or (self.busy and self.position_m[2] < LOW_M))

    @property
    def way(self) -> list[Vec2]:
        return [self.xy, *(p[:2] for p in self.path_m)]

    @property
    def heights_m(self) -> tuple[float, float]:
        """The lowest and the highest on its way, as far as it matters now."""
        heights = [self.position_m[2], *(p[2] for p in _stretch(self, _AHEAD_M))]
        return min(heights), max(heights)

    @property
    def mover(self) -> Mover:
        path = tuple(p[:2] for p in self.path_m)
        known = self.heights_m if self.heights_known else None
        return Mover(self.id, self.xy, path, self.radius_m + AROUND_M, known)


@dataclass(frozen=True, slots=True)
class AirRuling:
    """What one robot that flies is told."""

    ruling: Ruling
    height_m: float | None = None
    column_taken: bool = False
    land_at_m: Vec2 | None = None


def levels(lowest_m: float, highest_m: float) -> tuple[float, ...]:
    """Heights to travel at, from the bottom up; the lowest in any case."""
    count = int(max(0.0, highest_m - lowest_m) / SEPARATION_M + 1e-6)
    return tuple(round(lowest_m + k * SEPARATION_M, 3) for k in range(count + 1))


@dataclass
class Airspace:
    """Keeps levels, and what `Traffic` keeps, from one look to the next."""

    floor: FloorPlan
    levels_m: tuple[float, ...]
    tall: Callable[[Vec2, float], bool]
    """Whether known furniture reaches up to where robots fly."""
    blocked: Callable[[Vec2, float], bool]
    """Whether a body of some radius on the floor would touch known furniture at a place."""
    _level_of: dict[str, float] = field(default_factory=dict)
    _aside: dict[str, Vec2] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._traffic = Traffic(self.floor, self.tall)
        self._over, self._ground = Parking(self.floor, self.tall), Parking(self.floor, self.blocked)

    def rule(self, flyers: Sequence[Flyer], standing: Sequence[Mover], now_s: float) -> dict[str, AirRuling]:
        """Orders for all that flies. `standing`: everybody on the floor, those of `flyers` that are there too."""
        self._share_out(flyers)
        up = sorted((f for f in flyers if f.airborne), key=lambda f: f.id)
        rulings = self._traffic.rule([f.mover for f in up], now_s)
        for flyer in up:
            if flyer.rising:
                rulings[flyer.id] = Ruling(go=True)  # where it is going to is not far
        asides = self._columns(up, rulings) | self._make_room(up, flyers)
        self._aside = asides
        for id, spot in asides.items():
            rulings[id] = Ruling(go=True, step_aside_m=spot, because="in the column of another")
        return {f.id: self._with_column(f, rulings.get(f.id, Ruling(go=True)), up, standing) for f in flyers}

    def _share_out(self, flyers: Sequence[Flyer]) -> None:
        """A level for everybody, kept as long as it is there: the lowest of those that the fewest have."""
        there = {f.id for f in flyers}
        self._level_of = {id: level for id, level in self._level_of.items() if id in there}
        for flyer in sorted(flyers, key=lambda f: f.id):
            if flyer.id not in self._level_of:
                used = list(self._level_of.values())
                self._level_of[flyer.id] = min(self.levels_m, key=lambda level: (used.count(level), level))

    # One at a time in a column

    def _columns(self, up: Sequence[Flyer], rulings: dict[str, Ruling]) -> dict[str, Vec2]:
        """Who is over another and wants to come to its height waits; who hovers there makes room."""
        asides: dict[str, Vec2] = {}
        for mine in up:
            for other in up:
                if mine.id == other.id or not _over_each_other(mine, other) or not _comes_to(mine, other):
                    continue
                mutual = _comes_to(other, mine)
                if mutual and mine.id > other.id:
                    continue  # told to make room when it was the other's turn
                if rulings[mine.id].go:
                    why = f"{other.id} is {'under' if other.position_m[2] < mine.position_m[2] else 'over'} it"
                    rulings[mine.id] = Ruling(go=False, because=why, held_by=other.id)
                if mutual or not (other.path_m or other.rising):
                    self._find_aside(other, mine, up, asides)
        return asides

    def _make_room(self, up: Sequence[Flyer], flyers: Sequence[Flyer]) -> dict[str, Vec2]:
        """Who hovers over one that has something to do and stands on the floor."""
        asides: dict[str, Vec2] = {}
        for below in (f for f in flyers if f.busy and not f.airborne):
            for other in up:
                if not (other.path_m or other.rising) and dist(other.xy, below.xy) < _clear_m(other, below):
                    self._find_aside(other, below, up, asides)
        return asides

    def _find_aside(self, other: Flyer, first: Flyer, up: Sequence[Flyer], asides: dict[str, Vec2]) -> None:
        bodies = [f.mover for f in up if f.id != other.id]
        ways = [(first.mover, cut(first.way, _COLUMN_AHEAD_M))]
        kept = self._aside.get(other.id)
        good = kept is not None and self._over.good(kept, other.mover, ways, bodies)
        spot = kept if good else self._over.find(other.mover, ways, [b for b in bodies if b.id != first.id])
        if spot is not None:
            asides[other.id] = spot

    # Up from the floor and down to it

    def _with_column(self, flyer: Flyer, ruling: Ruling, up: Sequence[Flyer], standing: Sequence[Mover]) -> AirRuling:
        height_m = self._level_of[flyer.id] if len(self._level_of) > 1 else None
        in_air = [f.mover for f in up if f.id != flyer.id]
        if not flyer.airborne:
            return AirRuling(ruling, height_m, any(_in_column(flyer, m) for m in in_air))
        below = [f.mover for f in up if f.id != flyer.id and f.position_m[2] < flyer.position_m[2]]
        below += [m for m in standing if m.id != flyer.id]
        taken = any(_in_column(flyer, m) for m in below)
        homely = flyer.home_m is not None and dist(flyer.home_m, flyer.xy) < _HOME_M
        unfit = not homely and (self._in_door(flyer.xy) or self.blocked(flyer.xy, flyer.radius_m))
        stays = unfit or any(not m.path_m and _in_column(flyer, m) for m in below)
        spot = None
        if stays:
            mover = Mover(flyer.id, flyer.xy, (), flyer.radius_m)
            spot = self._ground.find(mover, [(m, m.way) for m in below if m.path_m], below)
        return AirRuling(ruling, height_m, taken or unfit, spot)

    def _in_door(self, point_m: Vec2) -> bool:
        return any(dist(point_m, door.middle_m) < _DOOR_M for door in self.floor.doors)


def _stretch(flyer: Flyer, length_m: float) -> list[Vec3]:
    """The points of its way up to a length over the floor."""
    left, here, points = length_m, flyer.xy, []
    for point in flyer.path_m:
        points.append(point)
        left -= dist(here, point[:2])
        here = point[:2]
        if left < 0.0:
            break
    return points


def _clear_m(a: Flyer, b: Flyer) -> float:
    return a.radius_m + b.radius_m + 2.0 * AROUND_M + _MARGIN_M


def _over_each_other(a: Flyer, b: Flyer) -> bool:
    return dist(a.xy, b.xy) < _clear_m(a, b) and abs(a.position_m[2] - b.position_m[2]) >= KEPT_M


def _comes_to(mine: Flyer, other: Flyer) -> bool:
    """Whether the way of one leads to the height of the other before it is clear of it."""
    here = mine.position_m
    for point in mine.path_m:
        if dist(point[:2], other.xy) >= _clear_m(mine, other) and dist(here[:2], other.xy) >= _clear_m(mine, other):
            return False
        low, high = sorted((here[2], point[2]))
        if low - KEPT_M < other.position_m[2] < high + KEPT_M:
            return True
        here = point
    return False


def _in_column(flyer: Flyer, other: Mover) -> bool:
    """Whether somebody is where a robot would go up or come down, or will soon be."""
    clear = flyer.radius_m + AROUND_M + other.radius_m + _MARGIN_M
    return point_to_path_m(flyer.xy, cut(other.way, _COLUMN_AHEAD_M)) < clear
