"""Train what sees cubes: `python -m sim.training.cubes.train --set DIR --out DIR`. The set comes from `dataset --twins 1`."""

import argparse
import logging
import math
import time
import warnings
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn
from torch.nn import functional

from devices.vision.cube_layout import (
    CROP_PX,
    KINDS,
    LETTERED,
    LETTERS,
    OFFSET_SCALE_PX,
    STRIDE_PX,
    crop,
    finder_picture,
    finder_scale,
    planes,
)
from devices.vision.gridmask import draw, grid_for
from devices.vision.picture import decode_jpeg
from sim.training.cubes.dataset import Example, read_labels
from sim.training.cubes.network import Finder, Reader

log = logging.getLogger("cubes")

CANVAS_PX = (288, 384)
"""Height and width that every picture at the finder's scale fits into."""
MARGIN_PX = 16
"""What the reader's kept pictures have around them, for shifts."""


@dataclass(frozen=True)
class Lesson:
    """All that is learnt from, in memory."""

    pictures: NDArray[np.uint8]
    """(N, H, W, 3) at the finder's scale."""
    points: list[NDArray[np.float64]]
    """For each picture (things, 3): kind, u and v on the canvas."""
    crops: NDArray[np.uint8]
    letters: NDArray[np.int64]
    turns_rad: NDArray[np.float64]


def prepare(folder: Path, examples: list[Example], grids: str) -> Lesson:
    """From pictures without a grid; `grids` says whether one is drawn: `with`, `without`, or `both` one after the other."""
    pictures, points, crops, letters, turns = [], [], [], [], []
    for example in examples:
        plain = decode_jpeg((folder / "pictures" / example.file).read_bytes())
        versions = {"with": [True], "without": [False], "both": [True, False]}[grids]
        for gridded in versions:
            rgb = draw(plain, grid_for(example.lens)) if gridded else plain
            small = finder_picture(rgb, example.lens)
            canvas = np.zeros((*CANVAS_PX, 3), np.uint8)
            canvas[: small.shape[0], : small.shape[1]] = small[: CANVAS_PX[0], : CANVAS_PX[1]]
            pictures.append(canvas)
            points.append(_points(example))
            for label in example.labels:
                letter = label.name.removeprefix("cube_")
                if letter in LETTERS and label.yaw_deg is not None:
                    u, v = grid_for(example.lens).pixel(label.x_cells, label.y_cells)
                    crops.append(crop(rgb, example.lens, u, v, CROP_PX + 2 * MARGIN_PX))
                    letters.append(LETTERS.index(letter))
                    turns.append(math.radians(label.yaw_deg))
    return Lesson(np.array(pictures), points, np.array(crops), np.array(letters), np.array(turns))


def _points(example: Example) -> NDArray[np.float64]:
    scale, grid = finder_scale(example.lens), grid_for(example.lens)
    rows = []
    for label in example.labels:
        u, v = grid.pixel(label.x_cells, label.y_cells)
        kind = label.part or (label.name if label.name in KINDS else LETTERED)
        rows.append((KINDS.index(kind), u * scale, v * scale))
    return np.array(rows).reshape(-1, 3)


def finder_targets(points: list[NDArray[np.float64]]) -> tuple[Tensor, Tensor, Tensor]:
    """Heat, offsets and where offsets count, for a batch of canvases."""
    height, width = CANVAS_PX[0] // STRIDE_PX, CANVAS_PX[1] // STRIDE_PX
    heat = np.zeros((len(points), len(KINDS), height, width), np.float32)
    offset = np.zeros((len(points), 2, height, width), np.float32)
    weight = np.zeros((len(points), height, width), np.float32)
    rows, columns = np.mgrid[0:height, 0:width]
    for n, things in enumerate(points):
        for kind, u, v in things:
            x, y = u / STRIDE_PX - 0.5, v / STRIDE_PX - 0.5
            column, row = int(np.clip(round(x), 0, width - 1)), int(np.clip(round(y), 0, height - 1))
            near = np.exp(-((rows - row) ** 2 + (columns - column) ** 2) / 1.2)
            heat[n, int(kind)] = np.maximum(heat[n, int(kind)], near)
            close = near > 0.4
            offset[n, 0][close] = ((u - (columns + 0.5) * STRIDE_PX) / OFFSET_SCALE_PX)[close]
            offset[n, 1][close] = ((v - (rows + 0.5) * STRIDE_PX) / OFFSET_SCALE_PX)[close]
            weight[n][close] = near[close]
    return torch.from_numpy(heat), torch.from_numpy(offset), torch.from_numpy(weight)


def finder_loss(output: Tensor, heat: Tensor, offset: Tensor, weight: Tensor) -> Tensor:
    logits, p = output[:, : len(KINDS)], torch.sigmoid(output[:, : len(KINDS)])
    peak = (heat == 1.0).float()
    hit = peak * (1.0 - p) ** 2 * functional.logsigmoid(logits)
    miss = (1.0 - peak) * (1.0 - heat) ** 4 * p**2 * functional.logsigmoid(-logits)
    focal = -(hit + miss).sum() / peak.sum().clamp(min=1.0)
    away = ((output[:, len(KINDS) :] - offset).abs().sum(dim=1) * weight).sum() / weight.sum().clamp(min=1.0)
    return focal + 2.0 * away


def reader_batch(lesson: Lesson, rng: np.random.Generator, size: int) -> tuple[Tensor, Tensor, Tensor]:
    """Letters turned, shifted and scaled anew."""
    chosen = rng.integers(len(lesson.crops), size=size)
    side, pictures, turns = CROP_PX + 2 * MARGIN_PX, [], []
    for n in chosen:
        turn_deg, scale = float(rng.uniform(-180.0, 180.0)), float(rng.uniform(0.9, 1.1))
        move = cv2.getRotationMatrix2D((side / 2.0, side / 2.0), turn_deg, scale)
        move[:, 2] += rng.normal(0.0, 1.5, 2) - MARGIN_PX
        pictures.append(cv2.warpAffine(lesson.crops[n], move, (CROP_PX, CROP_PX)))
        turns.append(lesson.turns_rad[n] + math.radians(turn_deg))
    turned = np.stack([np.cos(turns), np.sin(turns)], axis=1).astype(np.float32)
    return _jittered(np.array(pictures), rng), torch.from_numpy(lesson.letters[chosen]), torch.from_numpy(turned)


def _jittered(pictures: NDArray[np.uint8], rng: np.random.Generator) -> Tensor:
    """Other exposures."""
    gain = rng.uniform(0.75, 1.25, (len(pictures), 3, 1, 1)).astype(np.float32)
    shift = rng.uniform(-0.08, 0.08, (len(pictures), 1, 1, 1)).astype(np.float32)
    return torch.from_numpy(np.clip(planes(pictures) * gain + shift, 0.0, 1.0))


def reader_loss(output: Tensor, letters: Tensor, turned: Tensor) -> Tensor:
    return (
        functional.cross_entropy(output[:, : len(LETTERS)], letters) + (output[:, len(LETTERS) :] - turned).abs().mean()
    )


def learn(network: nn.Module, lesson: Lesson, steps: int, batch: int, seed: int, rate: float = 3e-3) -> float:
    """All steps; returns the last mean loss."""
    rng = np.random.default_rng(seed)
    optimiser = torch.optim.AdamW(network.parameters(), rate, weight_decay=1e-4)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, rate, total_steps=steps)
    began_s, mean = time.monotonic(), 0.0
    network.train()
    for step in range(steps):
        if isinstance(network, Finder):
            chosen = rng.integers(len(lesson.pictures), size=batch)
            targets = finder_targets([lesson.points[n] for n in chosen])
            loss = finder_loss(network(_jittered(lesson.pictures[chosen], rng)), *targets)
        else:
            pictures, letters, turned = reader_batch(lesson, rng, batch)
            loss = reader_loss(network(pictures), letters, turned)
        optimiser.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 5.0)
        optimiser.step()
        schedule.step()
        mean += (float(loss.detach()) - mean) * max(0.02, 1.0 / (step + 1))
        if (step + 1) % 100 == 0:
            log.info(
                "%s: step %d, loss %.3f, %.0f s", type(network).__name__, step + 1, mean, time.monotonic() - began_s
            )
    return mean


def export(network: nn.Module, size_px: tuple[int, int], path: Path) -> None:
    """As the ONNX file that devices run, for any number of pictures, and for the finder of any size."""
    network.eval()
    free = {0: "pictures"} | ({2: "height", 3: "width"} if isinstance(network, Finder) else {})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the exporter announces its own successor
        torch.onnx.export(
            network,
            (torch.zeros(1, 3, *size_px),),
            str(path),
            input_names=["picture"],
            output_names=["out"],
            dynamic_axes={"picture": free, "out": free},
            opset_version=17,
            dynamo=False,
        )


def main() -> None:
    parser = argparse.ArgumentParser(description="Train the two networks that see cubes from above.")
    parser.add_argument("--set", type=Path, required=True, help="made by `dataset N --twins 1`")
    parser.add_argument("--out", type=Path, required=True, help="folder for cube_finder.onnx and cube_reader.onnx")
    parser.add_argument("--grids", choices=("with", "without", "both"), default="both")
    parser.add_argument("--pictures", type=int, default=0, help="use so many; 0: all of the training split")
    parser.add_argument("--finder-steps", type=int, default=1200)
    parser.add_argument("--reader-steps", type=int, default=3000)
    parser.add_argument("--start", type=Path, help="folder of checkpoints to go on from")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    torch.manual_seed(arguments.seed)
    torch.set_num_threads(1)
    rows = [e for e in read_labels(arguments.set) if e.split == "train" and not e.gridded]
    lesson = prepare(arguments.set, rows[: arguments.pictures or None], arguments.grids)
    log.info("%d pictures, %d letters", len(lesson.pictures), len(lesson.crops))
    arguments.out.mkdir(parents=True, exist_ok=True)
    tasks: list[tuple[str, nn.Module, int, int, tuple[int, int]]] = [
        ("cube_finder", Finder(), arguments.finder_steps, 8, CANVAS_PX),
        ("cube_reader", Reader(), arguments.reader_steps, 64, (CROP_PX, CROP_PX)),
    ]
    for name, network, steps, batch, size_px in tasks:
        if arguments.start is not None:
            network.load_state_dict(torch.load(arguments.start / f"{name}.pt"))
        if steps:
            learn(network, lesson, steps, batch, arguments.seed, 3e-3 if arguments.start is None else 1e-3)
        torch.save(network.state_dict(), arguments.out / f"{name}.pt")
        export(network, size_px, arguments.out / f"{name}.onnx")


if __name__ == "__main__":
    main()
