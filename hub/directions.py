"""Traffic orders for the whole fleet: the rules of the floor and those of the air put together."""

from collections.abc import Sequence
from math import hypot

from hub.airspace import LOW_M, AirRuling, Airspace, Flyer, levels
from hub.fleet import Robot
from hub.floor import FloorPlan
from hub.kinds import shape
from hub.movers import Mover, Ruling
from hub.things import Things
from hub.traffic import Traffic
from wire.messages.command import TrafficOrder
from wire.model import Vec2
from wire.site import UNDER_CEILING_M, Site

_OTHERS_M = 4.0
"""Robots nearer than this are named to each other, to be kept clear of."""
_TALL_M = 1.2
"""Furniture up to here is flown over by the lowest of those who fly (`LOW_M`)."""
_USUAL_M = 1.5
"""The lowest level where the site file has no drone: one may be announced all the same."""
_NEAR_M = 1.6
"""The middle of a piece of furniture that reaches to a place is not farther off."""
_HUNG_M = 1.0
"""What begins higher hangs on a wall: who keeps clear of the wall keeps clear of it."""
_FOOTPRINT = 0.85
"""Of half a diagonal: a circle that stands for a rectangle, cut at its corners."""


class Directions:
    """Who goes, stands or steps aside, by where everybody says it is."""

    def __init__(self, site: Site, floor: FloorPlan, things: Things) -> None:
        self._things = things
        lowest_m = min((row.flight_height_m for row in site.robot if row.kind == "drone"), default=_USUAL_M)
        highest_m = min((room.height_m for room in site.room), default=0.0) - UNDER_CEILING_M
        self._floor = Traffic(floor, self._blocked)
        self._air = Airspace(floor, levels(lowest_m, highest_m), self._tall, self._blocked)
        self._orders = 0

    def orders(self, robots: Sequence[Robot], now_s: float) -> list[TrafficOrder]:
        """One for everybody, by id."""
        robots = sorted(robots, key=lambda r: r.id)
        flyers = {r.id: _flyer(r) for r in robots if r.airborne or r.flies}
        low = [r for r in robots if r.id not in flyers or _is_low(flyers[r.id])]
        movers = {r.id: Mover(r.id, r.xy, r.path_m, r.radius_m) for r in robots}
        floor = self._floor.rule([movers[r.id] for r in low], now_s)
        standing = [movers[r.id] for r in low if not r.airborne]
        air = self._air.rule(list(flyers.values()), standing, now_s) if flyers else {}
        self._orders += 1
        up = [r.id for r in robots if r.airborne]
        orders = []
        for robot in robots:
            mine, above = floor.get(robot.id), air.get(robot.id)
            near = [movers[id] for id in (floor if mine is not None else up)]
            ruling = _both(mine, above, flyers.get(robot.id))
            orders.append(self._order(movers[robot.id], ruling, above, near, now_s))
        return orders

    def _order(
        self, mover: Mover, ruling: Ruling, above: AirRuling | None, near: Sequence[Mover], now_s: float
    ) -> TrafficOrder:
        x, y = mover.position_m
        near = [m for m in near if m.id != mover.id and hypot(m.position_m[0] - x, m.position_m[1] - y) < _OTHERS_M]
        return TrafficOrder(
            robot=mover.id,
            seq=self._orders,
            stamp_s=now_s,
            go=ruling.go,
            step_aside_m=ruling.step_aside_m,
            others_m=tuple(m.position_m for m in near),
            because=ruling.because,
            height_m=above.height_m if above is not None else None,
            column_taken=above is not None and above.column_taken,
            land_at_m=above.land_at_m if above is not None else None,
        )

    def _blocked(self, point_m: Vec2, radius_m: float) -> bool:
        """Whether known furniture stands there."""
        return self._stands(point_m, radius_m, 0.0)

    def _tall(self, point_m: Vec2, radius_m: float) -> bool:
        """Whether known furniture stands there that reaches up to those who fly."""
        return self._stands(point_m, radius_m, _TALL_M)

    def _stands(self, point_m: Vec2, radius_m: float, top_m: float) -> bool:
        for thing in self._things.near(point_m[0], point_m[1], _NEAR_M):
            known = shape(thing.type)
            half_m = known.height_m / 2.0
            if known.kind == "pickup" or thing.z - half_m > _HUNG_M or thing.z + half_m < top_m:
                continue
            if hypot(thing.x - point_m[0], thing.y - point_m[1]) < _FOOTPRINT * known.half_diagonal_m + radius_m:
                return True
        return False


def _flyer(robot: Robot) -> Flyer:
    known = len(robot.path_heights_m) == len(robot.path_m)
    heights = robot.path_heights_m if known else (robot.position_m[2],) * len(robot.path_m)
    return Flyer(
        id=robot.id,
        position_m=robot.position_m,
        path_m=tuple((x, y, z) for (x, y), z in zip(robot.path_m, heights, strict=True)),
        airborne=robot.airborne,
        busy=robot.goal_id is not None,
        climb_mps=robot.velocity_mps[2],
        home_m=robot.home_m,
        radius_m=robot.radius_m,
        heights_known=known,
    )


def _is_low(flyer: Flyer) -> bool:
    return not flyer.airborne or flyer.heights_m[0] < LOW_M


def _both(floor: Ruling | None, above: AirRuling | None, flyer: Flyer | None) -> Ruling:
    """One ruling of two: of what flies low, the stricter; on its way up or down it makes way for nobody."""
    air = above.ruling if above is not None and flyer is not None and flyer.airborne else None
    if floor is None or (air is not None and flyer is not None and flyer.rising):
        return air or Ruling(go=True)
    if air is None or not floor.go:
        return floor
    return air if not air.go or air.step_aside_m is not None else floor
