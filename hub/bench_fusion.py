"""How many observations a second does F take, all in: decode, validate, associate, provenance, staleness, publish?

`python -m hub.bench_fusion [--json]` measures one core, and decoding alone beside it in the same run.
"""

import argparse
import json
import random
from collections.abc import Callable
from dataclasses import dataclass
from time import process_time

from hub.world import World
from wire.codec import decode, encode
from wire.messages.observation import ObjectObservation, ObservationBatch, View
from wire.site import Process, Room, Site

_BATCH = 50
_THINGS = 250
_SOURCES = 8
_PICTURE_S = 0.5
_DELTA_S = 0.1
_TYPES = ("Apple", "Book", "Bowl", "Chair", "DiningTable", "Fridge", "Mug", "Plate", "Sofa", "Television", "Tomato")
_PROPS = {"Bowl": "isDirty", "Fridge": "isOpen", "Mug": "isDirty", "Television": "isToggled", "Apple": "isSliced"}


@dataclass(frozen=True)
class Figures:
    """One measurement."""

    observations_per_s: float
    decode_per_s: float
    ratio: float
    """Time of the whole over the time of decoding alone."""
    observations: int
    objects_believed: int
    deltas: int


def measure(batches: int = 2000, seed: int = 1, rounds: int = 3) -> Figures:
    """The best of some rounds (others share the machine), decode and whole alternating."""
    site, payloads = _site(), _payloads(batches, seed)
    decoding, whole = [], []
    world, deltas = World(site), 0
    for _ in range(rounds):
        decoding.append(_time(lambda: _decode(payloads)))
        world, told = World(site), [0]
        whole.append(_time(lambda world=world, told=told: _fuse(world, payloads, told)))  # type: ignore[misc]
        deltas = told[0]
    count = batches * _BATCH
    return Figures(
        observations_per_s=round(count / min(whole)),
        decode_per_s=round(count / min(decoding)),
        ratio=round(min(whole) / min(decoding), 2),
        observations=count,
        objects_believed=len(world.snapshot(1e3).objects),
        deltas=deltas,
    )


def _decode(payloads: list[tuple[float, bytes]]) -> None:
    for _, payload in payloads:
        decode(ObservationBatch, payload)


def _fuse(world: World, payloads: list[tuple[float, bytes]], told: list[int]) -> None:
    due_s = 0.0
    for stamp_s, payload in payloads:
        world.observe(decode(ObservationBatch, payload))
        if stamp_s >= due_s:
            due_s = stamp_s + _DELTA_S
            delta = world.delta(stamp_s)
            if delta is not None:
                encode(delta)
                told[0] += 1
            world.upkeep(stamp_s)


def _time(work: Callable[[], object]) -> float:
    start = process_time()
    work()
    return process_time() - start


def _site() -> Site:
    rooms = tuple(Room(id=f"room-{i}", name=f"Room {i}", kind="Bedroom", polygon_m=_square(5.0 * i)) for i in range(6))
    return Site(name="bench", room=rooms, process=(Process(id="hub", role="hub", module="hub"),))


def _square(x: float) -> tuple[tuple[float, float], ...]:
    return ((x, 0.0), (x + 5.0, 0.0), (x + 5.0, 5.0), (x, 5.0))


def _payloads(batches: int, seed: int) -> list[tuple[float, bytes]]:
    """Pictures of a house full of things: every source sees its own neighbourhood, with noise, twice a second."""
    rng = random.Random(seed)
    things = [
        (rng.choice(_TYPES), 30.0 * (i + rng.random()) / _THINGS, rng.uniform(0.2, 4.8), rng.uniform(0.2, 1.2))
        for i in range(_THINGS)
    ]
    result = []
    for n in range(batches):
        source, stamp_s = n % _SOURCES, _PICTURE_S * (n // _SOURCES) + 0.01 * (n % _SOURCES)
        first = (_THINGS - _BATCH) * source // (_SOURCES - 1)
        seen = tuple(_look(rng, i, *things[i]) for i in range(first, first + _BATCH))
        x = 30.0 * first / _THINGS
        view = View(
            origin_enu_m=(x, 0.0, 2.3),
            polygon_m=((x, 0.0), (x + 6.0, 0.0), (x + 6.0, 5.0), (x, 5.0)),
            yaw_rad=0.8,
            hfov_rad=1.57,
            range_m=8.0,
        )
        batch = ObservationBatch(
            source=f"cam-{source}", boot_id="bench", seq=n, stamp_s=stamp_s, kind="cctv", objects=seen, view=view
        )
        result.append((stamp_s, encode(batch)))
    return result


def _look(rng: random.Random, index: int, type: str, x: float, y: float, z: float) -> ObjectObservation:
    prop = _PROPS.get(type)
    return ObjectObservation(
        track=f"t{index}",
        type=type,
        confidence=rng.uniform(0.6, 0.99),
        position_enu_m=(x + rng.gauss(0.0, 0.05), y + rng.gauss(0.0, 0.05), z + rng.gauss(0.0, 0.03)),
        covariance_m2=(0.006, 0.001, 0.006, 0.004),
        props={prop: rng.uniform(0.05, 0.3)} if prop is not None else {},
        box_px=(10.0, 20.0, 60.0, 80.0),
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="figures as JSON")
    parser.add_argument("--batches", type=int, default=2000)
    arguments = parser.parse_args()
    figures = measure(arguments.batches)
    if arguments.json:
        print(json.dumps(figures.__dict__))
    else:
        for name, value in figures.__dict__.items():
            print(f"{name:20} {value}")


if __name__ == "__main__":
    main()
