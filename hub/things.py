"""The set of things, found by id or by place."""

import random
from collections.abc import Iterator
from math import floor

from hub.records import Thing

_CELL_M = 1.0
_STRIDE = 100_003
FORGOTTEN = 1 << 62
"""The mark of a removed thing: later than any picture."""


class Things:
    """Every object that the hub believes in, in a grid of one-metre cells. Ids are opaque and the hub's own."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)
        self._cells: dict[int, list[Thing]] = {}
        self.by_id: dict[str, Thing] = {}
        self.touched: list[Thing] = []
        """Those that changed since the last delta."""
        self.removed: list[str] = []
        self.merged: dict[str, str] = {}
        """Ids given up because they were another thing's: old id -> the one that stands for it."""

    def __iter__(self) -> Iterator[Thing]:
        return iter(self.by_id.values())

    def __len__(self) -> int:
        return len(self.by_id)

    def get(self, id: str | None) -> Thing | None:
        return None if id is None else self.by_id.get(id)

    def new(self, type: str, position_m: tuple[float, float, float], stamp_s: float) -> Thing:
        thing = Thing(self._new_id(), type, position_m, stamp_s)
        self.add(thing)
        return thing

    def add(self, thing: Thing) -> None:
        self.by_id[thing.id] = thing
        thing.cell = _cell(thing.x, thing.y)
        self._cells.setdefault(thing.cell, []).append(thing)
        self.touch(thing)

    def bring_back(self, thing: Thing) -> None:
        """Add a thing under the id by which others have been told of it."""
        thing.shown, thing.version = 0, 1
        if thing.id in self.removed:
            self.removed.remove(thing.id)
        self.add(thing)

    def reseed(self, run: int) -> None:
        """Draw other ids from here on than earlier runs of the hub did."""
        self._random = random.Random(run)

    def _new_id(self) -> str:
        while True:
            id = f"obj-{self._random.randrange(16**4):04x}"
            if id not in self.by_id and id not in self.merged:
                return id

    def remove(self, thing: Thing) -> None:
        """Forget a thing, and everything's being in it. Tracks bound to it are free again."""
        thing.mark = FORGOTTEN
        del self.by_id[thing.id]
        self._cells[thing.cell].remove(thing)
        if thing.shown >= 0:
            self.removed.append(thing.id)
        for other in self.inside(thing):
            other.receptacle = None
            other.version += 1
            self.touch(other)

    def inside(self, holder: Thing) -> list[Thing]:
        """What is believed to be in or on it."""
        id = holder.id
        return [thing for thing in self.by_id.values() if thing.receptacle == id]

    def standing_for(self, id: str) -> str:
        """The id under which a thing is known now."""
        while id in self.merged:
            id = self.merged[id]
        return id

    def touch(self, thing: Thing) -> None:
        if not thing.touched:
            thing.touched = True
            self.touched.append(thing)

    def move(self, thing: Thing, position_m: tuple[float, float, float]) -> None:
        thing.x, thing.y, thing.z = position_m
        self.settle(thing)

    def settle(self, thing: Thing) -> None:
        """Put a thing whose position was changed into its cell."""
        cell = _cell(thing.x, thing.y)
        if cell != thing.cell:
            self._cells[thing.cell].remove(thing)
            thing.cell = cell
            self._cells.setdefault(cell, []).append(thing)

    def near(self, x: float, y: float, radius_m: float) -> list[Thing]:
        """Things in the cells that a circle touches (some lie outside of it)."""
        low_x, high_x = floor((x - radius_m) / _CELL_M), floor((x + radius_m) / _CELL_M)
        low_y, high_y = floor((y - radius_m) / _CELL_M), floor((y + radius_m) / _CELL_M)
        cells, found = self._cells, []
        for ix in range(low_x, high_x + 1):
            for cell in range(ix * _STRIDE + low_y, ix * _STRIDE + high_y + 1):
                if cell in cells:
                    found += cells[cell]
        return found


def _cell(x: float, y: float) -> int:
    return floor(x / _CELL_M) * _STRIDE + floor(y / _CELL_M)
