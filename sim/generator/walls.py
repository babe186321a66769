"""Walls of a floor plan as separate segments, with gaps where the doors are."""

from sim.generator.plan import FloorPlan, PlannedRoom
from sim.generator.statistics import WALL_HEIGHT_M, WALL_THICKNESS_M
from sim.scene import Door, Vec2, Wall

Span = tuple[float, float]


def draw_walls(plan: FloorPlan) -> tuple[Wall, ...]:
    inner = [
        _wall(piece, tuple(plan.rooms[r].id for r in edge.rooms))
        for edge in plan.edges
        for piece in _pieces(
            edge.start_m, edge.end_m, [(d.start_m, d.end_m) for d in _doors_in(edge.start_m, edge.end_m, plan.doors)]
        )
    ]
    outer = [_wall(piece, (room.id,)) for room in plan.rooms for piece in _outside(room, plan)]
    return (*outer, *inner)


def _wall(piece: tuple[Vec2, Vec2], rooms: tuple[str, ...]) -> Wall:
    return Wall(piece[0], piece[1], WALL_THICKNESS_M, WALL_HEIGHT_M, rooms)


def _doors_in(start_m: Vec2, end_m: Vec2, doors: tuple[Door, ...]) -> list[Door]:
    axis = 0 if end_m[0] > start_m[0] else 1
    return [
        d
        for d in doors
        if abs(d.start_m[1 - axis] - start_m[1 - axis]) < 1e-6
        and abs(d.end_m[1 - axis] - start_m[1 - axis]) < 1e-6
        and d.start_m[axis] >= start_m[axis] - 1e-6
        and d.end_m[axis] <= end_m[axis] + 1e-6
    ]


def _outside(room: PlannedRoom, plan: FloorPlan) -> list[tuple[Vec2, Vec2]]:
    """The parts of a room's sides that no other room shares."""
    a, found = room.area, []
    for start, end in (
        ((a.x0, a.y0), (a.x1, a.y0)),
        ((a.x0, a.y1), (a.x1, a.y1)),
        ((a.x0, a.y0), (a.x0, a.y1)),
        ((a.x1, a.y0), (a.x1, a.y1)),
    ):
        axis = 0 if end[0] > start[0] else 1
        shared = [
            (e.start_m, e.end_m)
            for e in plan.edges
            if room.id in (plan.rooms[e.rooms[0]].id, plan.rooms[e.rooms[1]].id)
            and abs(e.start_m[1 - axis] - start[1 - axis]) < 1e-6
            and abs(e.end_m[1 - axis] - start[1 - axis]) < 1e-6
        ]
        found += _pieces(start, end, shared)
    return found


def _pieces(start_m: Vec2, end_m: Vec2, gaps: list[tuple[Vec2, Vec2]]) -> list[tuple[Vec2, Vec2]]:
    """What is left of a line along an axis without the gaps."""
    axis = 0 if end_m[0] > start_m[0] else 1
    cuts: list[Span] = sorted((g[0][axis], g[1][axis]) for g in gaps)
    ends = [start_m[axis], *(value for cut in cuts for value in cut), end_m[axis]]
    pieces = [(low, high) for low, high in zip(ends[::2], ends[1::2], strict=True) if high - low > 1e-3]
    across = start_m[1 - axis]
    if axis == 0:
        return [((low, across), (high, across)) for low, high in pieces]
    return [((across, low), (across, high)) for low, high in pieces]
