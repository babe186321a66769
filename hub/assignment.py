"""The cheapest matching of rows to columns: the Hungarian method with potentials, in O(n^2 m)."""

from collections.abc import Sequence
from math import inf

FORBIDDEN = 1e6
"""A cost of this much or more is no match."""


def assign(costs: Sequence[Sequence[float]]) -> list[int | None]:
    """For each row its column, or None. As many matches as possible, then the least total cost."""
    rows = len(costs)
    if not rows or not costs[0]:
        return [None] * rows
    padded = [[*(min(c, FORBIDDEN) for c in row), *([FORBIDDEN] * rows)] for row in costs]
    columns = len(costs[0])
    matched = _hungarian(padded)
    return [
        column if column < columns and costs[row][column] < FORBIDDEN else None for row, column in enumerate(matched)
    ]


def _hungarian(cost: list[list[float]]) -> list[int]:
    """Column of each row; there are at least as many columns as rows. Index 0 is a sentinel throughout."""
    n, m = len(cost), len(cost[0])
    u, v = [0.0] * (n + 1), [0.0] * (m + 1)
    row_of, way = [0] * (m + 1), [0] * (m + 1)
    for i in range(1, n + 1):
        row_of[0] = i
        column = 0
        least, used = [inf] * (m + 1), [False] * (m + 1)
        while row_of[column]:
            used[column] = True
            row, delta, following = row_of[column], inf, 0
            for j in range(1, m + 1):
                if used[j]:
                    continue
                reduced = cost[row - 1][j - 1] - u[row] - v[j]
                if reduced < least[j]:
                    least[j], way[j] = reduced, column
                if least[j] < delta:
                    delta, following = least[j], j
            for j in range(m + 1):
                if used[j]:
                    u[row_of[j]] += delta
                    v[j] -= delta
                else:
                    least[j] -= delta
            column = following
        while column:
            row_of[column] = row_of[way[column]]
            column = way[column]
    result = [0] * n
    for j in range(1, m + 1):
        if row_of[j]:
            result[row_of[j] - 1] = j - 1
    return result
