"""The labelled set for a vision model: `python -m sim.training.cubes.dataset N --out DIR`. N pictures with their grid, and twins without.

    DIR/pictures/00017.jpg, 00017_plain.jpg      as a drone sees them, with the grid drawn and without
    DIR/chat.jsonl                               one conversation for each picture: prompt, picture, the right answer
    DIR/labels.jsonl                             what is true of each: lens, and every point in the site and in cells

A floor, its texture and its light belong to one split (train, validation or test) with all pictures of it.
"""

import argparse
import json
import logging
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from math import degrees, pi
from pathlib import Path
from typing import Any, Literal

import numpy as np

from devices.vision.gridmask import Grid, cells_of, draw, grid_for
from devices.vision.lens import Image, Lens
from devices.vision.picture import encode_jpeg
from devices.vision.prompt import BIRDS_EYE, LANDMARKS, system_text, user_text
from sim.training.cubes.scenes import CubeStudio, Shot, Truth

log = logging.getLogger("gridmask")

SHOTS_A_FLOOR = 10
TWINS = 0.2
"""Pictures of which there is one without a grid, too: a model that never saw one does badly without."""
JPEG_QUALITY = 92
Split = Literal["train", "validation", "test"]


@dataclass(frozen=True)
class Label:
    """One thing of the right answer."""

    name: str
    x_cells: float
    y_cells: float
    yaw_deg: int | None
    role: str | None
    part: str | None
    point_m: tuple[float, float, float]


@dataclass(frozen=True)
class Example:
    """One picture of the set."""

    file: str
    split: Split
    floor: int
    """Seed of the studio."""
    gridded: bool
    task: str
    lens: Lens
    labels: tuple[Label, ...]


def split_of(floor: int) -> Split:
    """Eight floors of ten are for training."""
    return {8: "validation", 9: "test"}.get(floor % 10, "train")  # type: ignore[return-value]


def examples(
    count: int, seed: int = 0, twins: float = TWINS, splits: Sequence[Split] = ("train", "validation", "test")
) -> Iterator[tuple[Example, Image]]:
    """So many pictures with their grid, each followed by its twin where it has one."""
    made, floor = 0, seed
    while made < count:
        if split_of(floor) in splits:
            studio = CubeStudio(floor)
            for _ in range(min(SHOTS_A_FLOOR, count - made)):
                yield from _pair(studio, made, twins)
                made += 1
            studio.close()
        floor += 1


def _pair(studio: CubeStudio, number: int, twins: float) -> Iterator[tuple[Example, Image]]:
    shot = studio.shoot()
    task, roles = _task(shot.truths, studio.rng)
    grid = grid_for(shot.lens)
    labels = tuple(sorted(_labels(shot, grid, roles), key=lambda label: (-label.y_cells, label.x_cells)))
    base = (split_of(studio.seed), studio.seed)
    yield Example(f"{number:05d}.jpg", *base, True, task, shot.lens, labels), draw(shot.rgb, grid)
    if (number * twins) % 1.0 + twins >= 1.0 - 1e-9:
        yield Example(f"{number:05d}_plain.jpg", *base, False, task, shot.lens, labels), shot.rgb


def _labels(shot: Shot, grid: Grid, roles: dict[str, str]) -> Iterator[Label]:
    for truth in shot.truths:
        at = cells_of(grid, shot.lens, truth.point_m)
        assert at is not None
        yaw_deg = None if truth.yaw_rad is None else _turned_deg(truth.yaw_rad, shot.lens)
        x, y = round(at[0], 2), round(at[1], 2)
        yield Label(truth.name, x, y, yaw_deg, roles.get(truth.name), truth.part, truth.point_m)


def _turned_deg(yaw_rad: float, lens: Lens) -> int:
    """In the picture, whose up is the camera's heading: -180 to 179, 0 when the letter stands upright."""
    return round(degrees(yaw_rad - lens.yaw_rad + pi / 2.0) + 180.0) % 360 - 180


def _task(truths: Sequence[Truth], rng: np.random.Generator) -> tuple[str, dict[str, str]]:
    """A task for the roles, or none in every other picture."""
    cubes = [t.name for t in truths if t.part is None]
    if not cubes or rng.random() < 0.5:
        return "", {}
    goal = cubes[int(rng.integers(len(cubes)))]
    word = goal.removeprefix("cube_")
    roles = {name: "obstacle" for name in cubes} | {"robot": "main"}
    side = LANDMARKS[int(rng.integers(len(LANDMARKS)))] if rng.random() < 0.5 else None
    roles[goal] = side or "target"
    if side is None:
        return f"Walk to the cube {word}.", roles
    where = {"front": "in front of", "back": "behind", "left": "to the left of", "right": "to the right of"}
    return f"Bring what you carry to the place {where[side.removeprefix('landmark_')]} the cube {word}.", roles


def answer_of(example: Example) -> str:
    """The right answer, in the form of the schema."""
    objects = [
        {"name": b.name, "x": b.x_cells, "y": b.y_cells, "yaw_deg": b.yaw_deg, "role": b.role, "part": b.part}
        for b in example.labels
    ]
    return json.dumps({"objects": objects, "texts": []}, separators=(",", ":"))


def conversation(example: Example) -> dict[str, Any]:
    """System text, picture and question, right answer: what a chat model is tuned on."""
    text = user_text(BIRDS_EYE, grid_for(example.lens), example.lens, example.task)
    content = [{"type": "image", "image": f"pictures/{example.file}"}, {"type": "text", "text": text}]
    return {
        "messages": [
            {"role": "system", "content": [{"type": "text", "text": system_text(BIRDS_EYE)}]},
            {"role": "user", "content": content},
            {"role": "assistant", "content": [{"type": "text", "text": answer_of(example)}]},
        ],
        "split": example.split,
        "gridded": example.gridded,
    }


def write_set(count: int, out: Path, seed: int = 0, twins: float = TWINS) -> dict[str, int]:
    """Write the whole set; returns how many pictures of each kind there are."""
    (out / "pictures").mkdir(parents=True, exist_ok=True)
    counts: dict[str, int] = {}
    with (out / "chat.jsonl").open("w") as chat, (out / "labels.jsonl").open("w") as labels:
        for example, rgb in examples(count, seed, twins):
            (out / "pictures" / example.file).write_bytes(encode_jpeg(rgb, JPEG_QUALITY))
            chat.write(json.dumps(conversation(example)) + "\n")
            labels.write(json.dumps(asdict(example)) + "\n")
            kind = f"{example.split}, {'with' if example.gridded else 'without'} grid"
            counts[kind] = counts.get(kind, 0) + 1
            if sum(counts.values()) % 100 == 0:
                log.info("%d pictures", sum(counts.values()))
    return counts


def read_labels(folder: Path) -> list[Example]:
    """The rows of a set's `labels.jsonl`."""
    rows = [json.loads(line) for line in (folder / "labels.jsonl").read_text().splitlines()]
    return [_example(row) for row in rows]


def _example(row: dict[str, Any]) -> Example:
    lens = Lens(**{**row["lens"], "position_enu_m": tuple(row["lens"]["position_enu_m"])})
    labels = tuple(Label(**{**label, "point_m": tuple(label["point_m"])}) for label in row["labels"])
    return Example(**{**row, "lens": lens, "labels": labels})


def main() -> None:
    parser = argparse.ArgumentParser(description="Make the labelled set of pictures with GridMask.")
    parser.add_argument("count", type=int, help="pictures with a grid; the paper's sets have 200, 400 and 1000")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--seed", type=int, default=0, help="of the first floor; equal seeds make equal sets")
    parser.add_argument("--twins", type=float, default=TWINS, help="part of the pictures that have a twin without grid")
    arguments = parser.parse_args()
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    if arguments.count < 1 or not 0.0 <= arguments.twins <= 1.0 or arguments.seed < 0:
        parser.error("give a number of pictures above 0, twins from 0 to 1, and a seed of 0 or more")
    for kind, number in sorted(write_set(arguments.count, arguments.out, arguments.seed, arguments.twins).items()):
        log.info("%s: %d", kind, number)


if __name__ == "__main__":
    main()
