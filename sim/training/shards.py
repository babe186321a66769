"""Pictures and labels on disk: JPEG bytes end to end, one row of lens numbers per picture, all labels in one table."""

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from devices.vision.lens import Lens
from sim.training.labels import LABEL, Labels


@dataclass
class Shard:
    """A number of pictures. `labels` are sorted by frame."""

    jpegs: list[bytes]
    lenses: list[Lens]
    labels: Labels

    def __post_init__(self) -> None:
        edges = np.searchsorted(self.labels["frame"], np.arange(len(self.jpegs) + 1)).tolist()
        self.spans = [slice(a, b) for a, b in pairwise(edges)]


def write_shard(path: Path, shard: Shard) -> None:
    lengths = np.array([len(jpeg) for jpeg in shard.jpegs], dtype=np.int64)
    data = np.frombuffer(b"".join(shard.jpegs), dtype=np.uint8)
    lenses = np.array([_numbers(lens) for lens in shard.lenses], dtype=np.float64)
    partial = path.with_suffix(".part.npz")
    np.savez(partial, data=data, lengths=lengths, lenses=lenses, labels=shard.labels)
    partial.rename(path)


def read_shards(paths: list[Path]) -> Shard:
    """All shards as one."""
    whole = Shard([], [], np.zeros(0, dtype=LABEL))
    tables: list[Labels] = []
    for path in sorted(paths):
        with np.load(path) as file:
            data, ends = file["data"].tobytes(), np.cumsum(file["lengths"]).tolist()
            labels = file["labels"]
            labels["frame"] += len(whole.jpegs)
            tables.append(labels)
            whole.jpegs += [data[a:b] for a, b in zip([0, *ends[:-1]], ends, strict=True)]
            whole.lenses += [_lens(row) for row in file["lenses"]]
    return Shard(whole.jpegs, whole.lenses, np.concatenate(tables))


def _numbers(lens: Lens) -> tuple[float, ...]:
    return (
        lens.width_px,
        lens.height_px,
        lens.focal_px,
        *lens.position_enu_m,
        lens.yaw_rad,
        lens.tilt_down_rad,
    )


def _lens(row: NDArray[np.float64]) -> Lens:
    width, height, focal, x, y, z, yaw, tilt = row.tolist()
    return Lens(int(width), int(height), focal, (x, y, z), yaw, tilt)
