"""Train the embedded detector: `python -m sim.training.train --frames DIR --steps N --out weights.onnx`."""

import argparse
import copy
import logging
import math
import queue
import threading
import time
from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path

import torch

from sim.training.batches import Batch, Sampler
from sim.training.export import export
from sim.training.losses import head_loss
from sim.training.network import DetectorNetwork
from sim.training.resume import resume
from sim.training.shards import read_shards

log = logging.getLogger("train")

WARM_UP = 200
RESUME_BATCHES = 8
"""That the statistics of the normalisation are taken from where the file has none."""
AVERAGE = 0.998
"""Of the running mean of the weights, which is what is kept."""


class Trainer:
    """The network, its running mean and its optimiser."""

    def __init__(self, steps: int, seed: int, rate: float, bfloat16: bool = False) -> None:
        torch.manual_seed(seed)
        self.network = DetectorNetwork().to(memory_format=torch.channels_last)  # type: ignore[call-overload]
        self.mean = copy.deepcopy(self.network)
        self.optimiser = torch.optim.AdamW(self.network.parameters(), rate, weight_decay=1e-4)
        self.steps, self.step, self._peak, self._bfloat16 = steps, 0, rate, bfloat16

    def start_from(self, path: Path, batches: Iterable[Batch]) -> None:
        """Go on from the weights of an earlier run, a checkpoint or the exported network."""
        if path.suffix == ".onnx":
            resume(self.network, path, [torch.from_numpy(batch.pictures) for batch in islice(batches, RESUME_BATCHES)])
        else:
            self.network.load_state_dict(torch.load(path))
        self.mean.load_state_dict(self.network.state_dict())

    def learn(self, batch: Batch) -> dict[str, float]:
        """One step; returns the terms of the loss."""
        for group in self.optimiser.param_groups:
            group["lr"] = self._rate()
        pictures = torch.from_numpy(batch.pictures).contiguous(memory_format=torch.channels_last)
        with torch.autocast("cpu", torch.bfloat16, enabled=self._bfloat16):
            outputs = self.network(pictures)
        terms = [head_loss(output, target) for output, target in zip(outputs, batch.targets, strict=True)]
        loss = torch.stack([value for head in terms for value in head.values()]).sum()
        self.optimiser.zero_grad()
        loss.backward()  # type: ignore[no-untyped-call]
        torch.nn.utils.clip_grad_norm_(self.network.parameters(), 10.0)
        self.optimiser.step()
        self.step += 1
        self._average()
        return {name: sum(float(head[name].detach()) for head in terms) for name in terms[0]}

    def _rate(self) -> float:
        warm = min(1.0, (self.step + 1) / WARM_UP)
        return self._peak * warm * (0.5 * (1.0 + math.cos(math.pi * min(1.0, self.step / self.steps))) + 0.005)

    @torch.no_grad()
    def _average(self) -> None:
        keep = min(AVERAGE, (1.0 + self.step) / (10.0 + self.step))
        for mean, now in zip(self.mean.state_dict().values(), self.network.state_dict().values(), strict=True):
            if mean.is_floating_point():
                mean.lerp_(now, 1.0 - keep)
            else:
                mean.copy_(now)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=Path, required=True, help="folder of shards made by sim.training.frames")
    parser.add_argument("--steps", type=int, default=12000)
    parser.add_argument("--batch", type=int, default=16)
    parser.add_argument("--rate", type=float, default=3e-3, help="of learning, at its highest")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--bfloat16", action="store_true", help="faster where the processor has AMX, slower elsewhere")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--keep", type=int, default=1000, help="write the weights every so many steps")
    parser.add_argument("--start", type=Path, help="weights to go on from, .pt or .onnx, with a fresh schedule")
    parser.add_argument("--out", type=Path, required=True)
    arguments = parser.parse_args()
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    torch.set_num_threads(arguments.threads)
    shard = read_shards(list(arguments.frames.glob("*.npz")))
    log.info("%d pictures, %d labels", len(shard.jpegs), len(shard.labels))
    trainer = Trainer(arguments.steps, arguments.seed, arguments.rate, arguments.bfloat16)
    sampler = Sampler(shard, arguments.batch, arguments.seed)
    if arguments.start is not None:
        trainer.start_from(arguments.start, sampler)
    run(trainer, sampler, arguments.keep, arguments.out)


def prefetch(batches: Iterable[Batch]) -> Iterator[Batch]:
    """The same batches, made in a thread while the network learns."""
    made: queue.Queue[Batch] = queue.Queue(maxsize=4)

    def fill() -> None:
        for batch in batches:
            made.put(batch)

    threading.Thread(target=fill, daemon=True).start()
    while True:
        yield made.get()


def run(trainer: Trainer, sampler: Sampler, keep: int, out: Path) -> None:
    """All steps, writing the mean network now and then and at the end."""
    started_s = time.monotonic()
    shown: dict[str, float] = {}
    for batch in prefetch(sampler):
        for name, value in trainer.learn(batch).items():
            shown[name] = 0.98 * shown.get(name, value) + 0.02 * value
        if trainer.step % 100 == 0:
            terms = " ".join(f"{name} {value:.3f}" for name, value in shown.items())
            log.info("%d %.0f s %s", trainer.step, time.monotonic() - started_s, terms)
        if trainer.step % keep == 0 or trainer.step == trainer.steps:
            torch.save(trainer.mean.state_dict(), out.with_suffix(".pt"))
            export(trainer.mean, out)
        if trainer.step == trainer.steps:
            return


if __name__ == "__main__":
    main()
