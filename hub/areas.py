"""How much of each room has been looked at, by whom and when: views painted on a quarter-metre grid of bits."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from math import ceil, floor

from wire.messages.observation import ObservationBatch
from wire.messages.world import AreaState
from wire.model import Vec2
from wire.outline import spans
from wire.site import Room

CELL_M = 0.25
_SEARCHED = 0.9


@dataclass
class _Area:
    room: Room
    x_m: float
    y_m: float
    columns: int
    rows: list[int]
    """The cells of the room itself, a bit each."""
    cells: int
    seen: list[int]
    robots: list[int]
    """Seen by robots since the task began."""
    cameras: dict[str, list[int]] = field(default_factory=dict)
    stamp_s: float | None = None
    source: str | None = None
    searched: bool = False
    searches: int = 0
    from_above: set[str] = field(default_factory=set)
    """Names of the fields of `AreaState` that robots in the air have made true in this task."""
    shown: AreaState | None = None
    touched: bool = True


class Areas:
    """S^A of equation 1."""

    def __init__(self, rooms: tuple[Room, ...]) -> None:
        self._areas = [_lay(room) for room in rooms]
        self._by_id = {area.room.id: area for area in self._areas}
        self._fixed: dict[str, tuple[Vec2, ...]] = {}
        """The view of every fixed camera: painted once, as long as it stays the same."""

    def take(self, batch: ObservationBatch) -> None:
        """Paint what a picture showed."""
        view = batch.view
        if view is None or len(view.polygon_m) < 3:
            return
        if batch.kind == "cctv":
            if self._fixed.get(batch.source) == view.polygon_m:
                self._stamp(batch)
                return
            self._fixed[batch.source] = view.polygon_m
        left, right = min(p[0] for p in view.polygon_m), max(p[0] for p in view.polygon_m)
        low, high = min(p[1] for p in view.polygon_m), max(p[1] for p in view.polygon_m)
        for area in self._areas:
            width, height = area.columns * CELL_M, len(area.rows) * CELL_M
            if right < area.x_m or low > area.y_m + height or left > area.x_m + width or high < area.y_m:
                area.cameras.pop(batch.source, None)
                continue
            self._paint(area, paint(view.polygon_m, area.x_m, area.y_m, area.columns, len(area.rows)), batch)

    def _stamp(self, batch: ObservationBatch) -> None:
        for area in self._areas:
            if batch.source in area.cameras:
                area.stamp_s, area.source, area.touched = batch.stamp_s, batch.source, True

    def _paint(self, area: _Area, mask: list[int], batch: ObservationBatch) -> None:
        mask = [m & r for m, r in zip(mask, area.rows, strict=True)]
        if not any(mask):
            return
        area.seen = [a | m for a, m in zip(area.seen, mask, strict=True)]
        if batch.kind == "robot":
            area.robots = [a | m for a, m in zip(area.robots, mask, strict=True)]
            area.searched = area.searched or _share(area.robots, area) >= _SEARCHED
        elif batch.kind == "cctv":
            area.cameras[batch.source] = mask
        area.stamp_s, area.source, area.touched = batch.stamp_s, batch.source, True

    def begin_task(self) -> None:
        """Searches are counted from here."""
        for area in self._areas:
            area.robots = [0] * len(area.rows)
            area.searched, area.searches, area.touched = False, 0, True
            area.from_above.clear()

    def flown_over(self, room: str, how: str, robot: str, stamp_s: float) -> None:
        """`how`: `seen_from_above` or `surveyed`."""
        area = self._by_id.get(room)
        if area is not None:
            area.from_above.add(how)
            area.source, area.stamp_s, area.touched = robot, stamp_s, True

    def search_done(self, room: str, robot: str, stamp_s: float) -> None:
        area = self._by_id.get(room)
        if area is not None:
            area.searched, area.source, area.stamp_s, area.touched = True, robot, stamp_s, True
            area.searches += 1

    def remember_searched(self, room: str) -> None:
        """As an earlier run of the hub knew it; who saw what when is not remembered."""
        area = self._by_id.get(room)
        if area is not None:
            area.searched, area.touched = True, True

    def searched(self) -> tuple[str, ...]:
        return tuple(area.room.id for area in self._areas if area.searched)

    def from_above(self) -> dict[str, list[str]]:
        """Of the rooms that were flown over: how. For the journal."""
        return {area.room.id: sorted(area.from_above) for area in self._areas if area.from_above}

    def remember_from_above(self, room: str, how: Iterable[str]) -> None:
        """As an earlier run of the hub knew it."""
        area = self._by_id.get(room)
        if area is not None:
            area.from_above.update(how)
            area.touched = True

    def states(self) -> tuple[AreaState, ...]:
        return tuple(_state(area) for area in self._areas)

    def changes(self) -> tuple[AreaState, ...]:
        """Areas that a reader would see differently than at the last call."""
        changed = []
        for area in self._areas:
            if not area.touched:
                continue
            area.touched = False
            state = _state(area)
            if area.shown is None or _differs(area.shown, state):
                area.shown = state
                changed.append(state)
        return tuple(changed)


def paint(polygon_m: tuple[Vec2, ...], x_m: float, y_m: float, columns: int, rows: int) -> list[int]:
    """Rows of bits: the cells whose middle lies in the polygon (scan lines, even-odd rule)."""
    result = []
    for row in range(rows):
        y = y_m + (row + 0.5) * CELL_M
        bits = 0
        for left, right in spans(polygon_m, y):
            first = min(max(ceil((left - x_m) / CELL_M - 0.5), 0), columns)
            last = min(max(ceil((right - x_m) / CELL_M - 0.5), 0), columns)
            if last > first:
                bits |= ((1 << (last - first)) - 1) << first
        result.append(bits)
    return result


def _lay(room: Room) -> _Area:
    xs, ys = [p[0] for p in room.polygon_m], [p[1] for p in room.polygon_m]
    x, y = floor(min(xs) / CELL_M) * CELL_M, floor(min(ys) / CELL_M) * CELL_M
    columns, rows = ceil((max(xs) - x) / CELL_M), ceil((max(ys) - y) / CELL_M)
    bits = paint(room.polygon_m, x, y, columns, rows)
    blank = [0] * rows
    return _Area(room, x, y, columns, bits, sum(b.bit_count() for b in bits), blank, list(blank))


def _share(mask: list[int], area: _Area) -> float:
    return sum(m.bit_count() for m in mask) / area.cells if area.cells else 0.0


def _state(area: _Area) -> AreaState:
    cameras = [0] * len(area.rows)
    for mask in area.cameras.values():
        cameras = [a | m for a, m in zip(cameras, mask, strict=True)]
    return AreaState(
        id=area.room.id,
        name=area.room.name,
        kind=area.room.kind,
        seen_fraction=round(_share(area.seen, area), 3),
        camera_fraction=round(_share(cameras, area), 3),
        stamp_s=area.stamp_s,
        source=area.source,
        searched=area.searched,
        searches=area.searches,
        seen_from_above="seen_from_above" in area.from_above,
        surveyed="surveyed" in area.from_above,
    )


def _told(area: AreaState) -> tuple[bool, int, bool, bool]:
    return (area.searched, area.searches, area.seen_from_above, area.surveyed)


def _differs(a: AreaState, b: AreaState) -> bool:
    return (
        _told(a) != _told(b)
        or abs(a.seen_fraction - b.seen_fraction) >= 0.02
        or abs(a.camera_fraction - b.camera_fraction) >= 0.02
        or (b.stamp_s or 0.0) - (a.stamp_s or 0.0) >= 5.0
    )
