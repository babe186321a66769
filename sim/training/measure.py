"""How good the shipped detector is, on homes it was not trained on.

`python -m sim.training.measure --houses 9000-9005` writes the table of `docs/detector.md`; `--json` prints it.
"""

import argparse
import json
import sys
import time
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from devices.vision import layout
from devices.vision.detector import EmbeddedDetector
from devices.vision.picture import decode_jpeg
from devices.vision.projection import locate
from devices.vision.walls import before_walls
from sim.training.batches import clear_enough
from sim.training.frames import Shot, shoot_home, shoot_tidy, span
from sim.training.matching import Matched, match
from sim.training.report import table, write_report
from wire.catalogue import PROPS

CAMERAS = ("home", "cctv", "mast")
"""See `sim.training.frames.Shot`."""


@dataclass
class Tally:
    """Counts over pictures of one kind of camera."""

    found: dict[str, int] = field(default_factory=lambda: defaultdict(int))
    missed: dict[str, int] = field(default_factory=lambda: defaultdict(int))
    wrong: dict[str, int] = field(default_factory=lambda: defaultdict(int))
    errors_m: list[float] = field(default_factory=list)
    surprise: list[float] = field(default_factory=list)
    """Squared position error over its stated variance, in the floor plane: 2 on average when honest."""
    states: dict[str, list[bool]] = field(default_factory=lambda: defaultdict(list))
    pictures: int = 0

    def add(self, matched: Matched) -> None:
        """Take in one picture."""
        names = layout.detector_types()
        self.pictures += 1
        for label in matched.missed:
            self.missed[names[label["type"]]] += 1
        for sighting in matched.wrong:
            self.wrong[sighting.detection.type] += 1
        for label, sighting in matched.pairs:
            self.found[sighting.detection.type] += 1
            if sighting.detection.type == layout.ROBOT:
                continue
            error = np.array(sighting.position_enu_m[:2]) - label["position"][:2]
            xx, xy, yy, _ = sighting.covariance_m2
            self.errors_m.append(float(np.hypot(*error)))
            self.surprise.append(float(error @ np.linalg.solve([[xx, xy], [xy, yy]], error)))
            for prop, value in zip(PROPS, label["props"].tolist(), strict=True):
                if value >= 0:
                    self.states[prop].append((sighting.detection.props[prop] > 0.5) == bool(value))

    def summary(self) -> dict[str, Any]:
        """The figures, rounded to what they are worth."""
        found, missed, wrong = (sum(d.values()) for d in (self.found, self.missed, self.wrong))
        return {
            "pictures": self.pictures,
            "things": found + missed,
            "precision": _share(found, wrong),
            "recall": _share(found, missed),
            "position_error_m": {
                name: round(float(np.quantile(self.errors_m or [0.0], q)), 3)
                for name, q in (("median", 0.5), ("p90", 0.9))
            },
            "surprise_median": round(float(np.median(self.surprise or [0.0])), 2),
            "states": {
                p: {"accuracy": _share(sum(v), len(v) - sum(v)), "seen": len(v)} for p, v in self.states.items()
            },
            "types": {
                name: {
                    "precision": _share(self.found[name], self.wrong[name]),
                    "recall": _share(self.found[name], self.missed[name]),
                    "things": self.found[name] + self.missed[name],
                }
                for name in layout.detector_types()
            },
        }


def measure(shots: Sequence[Shot], detector: EmbeddedDetector) -> dict[str, Any]:
    """The figures by kind of camera: the fixed ones without depth, the robots' with it."""
    tallies = {name: Tally() for name in CAMERAS}
    everything = np.concatenate([shot.labels for shot in shots])
    clear, first = clear_enough(everything), 0
    looking_ms = defaultdict(list)
    for shot in shots:
        rgb = decode_jpeg(shot.jpeg)
        started_s = time.thread_time()
        detections = detector.look(rgb, shot.lens)
        looking_ms[shot.camera].append(1000.0 * (time.thread_time() - started_s))
        if shot.camera == "mast":
            sightings = locate(detections, shot.lens, shot.depth_m)
        else:
            sightings = before_walls(locate(detections, shot.lens), shot.lens, shot.walls, shot.doors)
        last = first + len(shot.labels)
        tallies[shot.camera].add(match(shot.labels, clear[first:last], sightings))
        first = last
    return {
        name: {**tally.summary(), "look_ms": round(float(np.median(looking_ms[name] or [0.0])), 1)}
        for name, tally in tallies.items()
    }


def _share(good: int, bad: int) -> float | None:
    return round(good / (good + bad), 3) if good + bad else None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--houses", type=span, default=span("9000-9005"))
    parser.add_argument("--weights", type=Path, help="an ONNX file other than the shipped one")
    parser.add_argument("--json", action="store_true", help="print the figures")
    parser.add_argument("--report", type=Path, help="replace the table in this file")
    arguments = parser.parse_args()
    shots = [shot for seed in arguments.houses for shot in (*shoot_tidy(seed), *shoot_home(seed, cctv=24, mast=24))]
    figures = measure(shots, EmbeddedDetector(arguments.weights))
    if arguments.report is not None:
        write_report(arguments.report, figures)
    sys.stdout.write((json.dumps(figures, indent=1) if arguments.json else table(figures)) + "\n")


if __name__ == "__main__":
    main()
