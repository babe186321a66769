"""How right a report is: pairs of what is reported and what is there, in cells of the grid and in metres. Pure."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import dist, hypot, pi

import numpy as np

from devices.vision.gridmask import flat_place_m, grid_for, place_m
from devices.vision.reply import Report
from sim.training.cubes.dataset import Example, Label

FAR_CELLS = 4.0
"""Of a report under the right name, further off than this is another thing."""
NEAR_CELLS = 0.5
"""Under another name, nearer than this it is the same thing misnamed."""
TURNS: dict[str, int] = {"I": 2, "H": 2, "N": 2, "O": 2, "S": 2, "X": 2, "Z": 2}
"""Letters that look the same after half a turn."""


@dataclass
class Tally:
    """Errors of many pictures."""

    cells: list[float] = field(default_factory=list)
    """Between the place reported and the true one, in cells: the deviation of the second paper's Figure 5."""
    flat_m: list[float] = field(default_factory=list)
    """The same on the floor by equation 7 as it stands."""
    corrected_m: list[float] = field(default_factory=list)
    """The same with attitude and height taken into account."""
    yaw_rad: list[float] = field(default_factory=list)
    there: int = 0
    found: int = 0
    misnamed: int = 0
    invented: int = 0
    pictures: int = 0
    unusable: int = 0
    """Replies that were none."""
    took_s: list[float] = field(default_factory=list)
    prompt_tokens: int = 0
    completion_tokens: int = 0

    def add(self, example: Example, report: Report) -> None:
        """Take in one picture's report."""
        self.pictures += 1
        self.there += len(example.labels)
        entries = [e for e in report.entries if e.name != "place"]
        pairs = _pairs(example.labels, [(e.name, e.part, e.x_cells, e.y_cells) for e in entries])
        self.invented += len(entries) - len(pairs)
        grid = grid_for(example.lens)
        for number, label, named in pairs:
            entry = entries[number]
            if not named:
                self.misnamed += 1
                continue
            self.found += 1
            at = (entry.x_cells, entry.y_cells)
            self.cells.append(dist(at, (label.x_cells, label.y_cells)))
            flat = flat_place_m(grid, example.lens, *at)
            self.flat_m.append(dist(flat, label.point_m[:2]))
            place = place_m(grid, example.lens, *at, label.point_m[2])
            if place is not None:
                self.corrected_m.append(dist(place[:2], label.point_m[:2]))
            if label.yaw_deg is not None and entry.yaw_rad is not None:
                self.yaw_rad.append(_turn_error(entry.yaw_rad, label))

    def summary(self) -> dict[str, float | int | None]:
        """The figures of one run."""
        seen = self.found + self.misnamed
        return {
            "pictures": self.pictures,
            "things": self.there,
            "valid_replies": _share(self.pictures - self.unusable, self.pictures),
            "recall": _share(self.found, self.there),
            "identity_right": _share(self.found, seen),
            "invented_per_picture": _share(self.invented, self.pictures),
            "deviation_cells_median": _quantile(self.cells, 0.5),
            "deviation_cells_p90": _quantile(self.cells, 0.9),
            "deviation_cells_mean": float(np.mean(self.cells)) if self.cells else None,
            "flat_m_median": _quantile(self.flat_m, 0.5),
            "corrected_m_median": _quantile(self.corrected_m, 0.5),
            "corrected_m_p90": _quantile(self.corrected_m, 0.9),
            "yaw_rad_median": _quantile(self.yaw_rad, 0.5),
            "seconds_per_picture": _quantile(self.took_s, 0.5),
            "prompt_tokens": self.prompt_tokens,
            "completion_tokens": self.completion_tokens,
        }


def _pairs(
    labels: Sequence[Label], said: Sequence[tuple[str, str | None, float, float]]
) -> list[tuple[int, Label, bool]]:
    """(number of the entry, label, whether it has its name), nearest first: those of one name, then the misnamed."""
    pairs: list[tuple[int, Label, bool]] = []
    for named, limit in ((True, FAR_CELLS), (False, NEAR_CELLS)):
        options = sorted(
            (hypot(x - label.x_cells, y - label.y_cells), i, j)
            for i, (name, part, x, y) in enumerate(said)
            for j, label in enumerate(labels)
            if ((name, part) == (label.name, label.part)) == named
        )
        for apart, i, j in options:
            if apart <= limit and all(n != i and b is not labels[j] for n, b, _ in pairs):
                pairs.append((i, labels[j], named))
    return pairs


def _turn_error(yaw_rad: float, label: Label) -> float:
    assert label.yaw_deg is not None
    full = 2.0 * pi / TURNS.get(label.name.removeprefix("cube_"), 1)
    away = (yaw_rad - label.yaw_deg * pi / 180.0) % full
    return min(away, full - away)


def _share(part: int, whole: int) -> float | None:
    return part / whole if whole else None


def _quantile(values: Sequence[float], share: float) -> float | None:
    return float(np.quantile(values, share)) if values else None
