"""The floor cut into square cells: which cell a point is in, and which lie around it, along a line, in a room.

A cell is one number: they are counted row by row from the south-west corner of the building. Plain Python, for numpy
alone takes a quarter of the memory of a robot without a camera.
"""

from array import array
from collections.abc import Iterator, Sequence
from math import ceil, floor, hypot
from typing import TypeAlias

from wire.model import Vec2
from wire.outline import spans
from wire.site import Site

CELL_M = 0.1
MARGIN_M = 0.3

Cell: TypeAlias = int
Grid: TypeAlias = "array[float]"
"""A single-precision number for every cell."""
Mask: TypeAlias = bytearray
"""1 for every cell that is meant, else 0."""


class CellGrid:
    """Cells over all rooms of a site and a margin around them."""

    def __init__(self, site: Site) -> None:
        corners = [corner for room in site.room for corner in room.polygon_m]
        xs, ys = [x for x, _ in corners], [y for _, y in corners]
        self.west_m, self.south_m = min(xs) - MARGIN_M, min(ys) - MARGIN_M
        self.columns = ceil((max(xs) + MARGIN_M - self.west_m) / CELL_M)
        self.rows = ceil((max(ys) + MARGIN_M - self.south_m) / CELL_M)
        self.size = self.rows * self.columns
        self._x = [self.west_m + (k + 0.5) * CELL_M for k in range(self.columns)]
        self._y = [self.south_m + (k + 0.5) * CELL_M for k in range(self.rows)]

    def cell(self, point_m: Vec2) -> Cell:
        """The cell of a point; a point outside gets the nearest."""
        column = floor((point_m[0] - self.west_m) / CELL_M)
        row = floor((point_m[1] - self.south_m) / CELL_M)
        return min(max(row, 0), self.rows - 1) * self.columns + min(max(column, 0), self.columns - 1)

    def cell_inside(self, point_m: Vec2) -> Cell | None:
        """The cell of a point; None for a point outside."""
        column, row = (point_m[0] - self.west_m) / CELL_M, (point_m[1] - self.south_m) / CELL_M
        if 0.0 <= column < self.columns and 0.0 <= row < self.rows:
            return int(row) * self.columns + int(column)
        return None

    def centre_m(self, cell: Cell) -> Vec2:
        row, column = divmod(cell, self.columns)
        return (self._x[column], self._y[row])

    def distance_m(self, point_m: Vec2) -> list[float]:
        """From every cell's centre to the point."""
        across = [x - point_m[0] for x in self._x]
        return [hypot(dx, y - point_m[1]) for y in self._y for dx in across]

    def around(self, point_m: Vec2, radius_m: float) -> Iterator[tuple[Cell, float]]:
        """Cells whose centre is within a radius of a point, in order, each with its distance."""
        for row, columns in self.box(point_m, point_m, radius_m):
            dy = self._y[row] - point_m[1]
            for column in columns:
                away_m = hypot(self._x[column] - point_m[0], dy)
                if away_m <= radius_m:
                    yield row * self.columns + column, away_m

    def box(self, start_m: Vec2, end_m: Vec2, margin_m: float) -> Iterator[tuple[int, range]]:
        """Rows, each with its columns, of the box around a straight line and a margin."""
        west, east = sorted((start_m[0], end_m[0]))
        south, north = sorted((start_m[1], end_m[1]))
        first = floor((west - margin_m - self.west_m) / CELL_M)
        last = floor((east + margin_m - self.west_m) / CELL_M)
        columns = range(max(first, 0), min(last + 1, self.columns))
        low = floor((south - margin_m - self.south_m) / CELL_M)
        high = floor((north + margin_m - self.south_m) / CELL_M)
        for row in range(max(low, 0), min(high + 1, self.rows)):
            yield row, columns

    def inside(self, polygon_m: Sequence[Vec2]) -> Mask:
        """Cells whose centre lies in the polygon."""
        result = bytearray(self.size)
        for row, y in enumerate(self._y):
            for west, east in spans(polygon_m, y):
                for column, x in enumerate(self._x, row * self.columns):
                    if west <= x < east:
                        result[column] = 1
        return result

    def along(self, start_m: Vec2, end_m: Vec2) -> list[Cell]:
        """The cells under a straight line, one every half cell."""
        count = max(2, ceil(2.0 * hypot(end_m[0] - start_m[0], end_m[1] - start_m[1]) / CELL_M) + 1)
        x, y = start_m
        dx, dy = (end_m[0] - x) / (count - 1), (end_m[1] - y) / (count - 1)
        if self.cell_inside(start_m) is None or self.cell_inside(end_m) is None:
            return [self.cell((x + k * dx, y + k * dy)) for k in range(count)]
        west, south, columns = self.west_m, self.south_m, self.columns
        return [
            int((y + k * dy - south) / CELL_M) * columns + int((x + k * dx - west) / CELL_M) for k in range(count - 1)
        ] + [self.cell(end_m)]
