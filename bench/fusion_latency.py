"""From an observation put on the wire to the world state decoded at a subscriber, beside bare Zenoh's round trip.

Both take turns in one run, at one pace: a machine that dozes between two messages wakes as slowly for either.

`python -m bench.fusion_latency --json`
"""

import argparse
import json
import time
from collections.abc import Callable
from contextlib import ExitStack
from typing import Any

from bench.children import PING, PONG
from bench.mesh import spread
from bench.stage import Stage, stage
from wire.bus import Received
from wire.clock import WallClock
from wire.codec import encode
from wire.keys import TOPIC
from wire.letter import NO_TICK, write_stamp
from wire.link import client_config, link_for
from wire.messages.observation import ObjectObservation, ObservationBatch
from wire.messages.world import WorldDelta
from wire.node import ZenohNode, node_for, open_session
from wire.paths import key

BATCHES, WARM_UP = 400, 20
EVERY_S = 0.05
OBJECTS = 10


class Ping:
    """One sample to a plain session and back: the floor."""

    def __init__(self, place: Stage, session: Any) -> None:
        self._answers = session.declare_subscriber(f"{place.site.realm}/{PONG}")
        self._ping = session.declare_publisher(f"{place.site.realm}/{PING}")

    def __call__(self, number: int) -> bool:
        self._ping.put(b"x" * 120)
        return self._answers.recv() is not None


class Observe:
    """One batch to the hub, and its news at a viewer."""

    def __init__(self, place: Stage, camera: Any, viewer: ZenohNode) -> None:
        self._out = camera.declare_publisher(key(place.site.realm, TOPIC["observation"].path, "cam-1"))
        begin_s = WallClock().now_s()
        self._stamps_s = [begin_s + number * EVERY_S for number in range(BATCHES)]
        self._batches = [encode(_batch(number, stamp_s)) for number, stamp_s in enumerate(self._stamps_s)]
        self._viewer = viewer
        viewer.subscribe("world_delta")

    def __call__(self, number: int) -> bool:
        self._out.put(self._batches[number], attachment=write_stamp(NO_TICK, number, "cctv-1"))
        deadline = time.perf_counter() + 0.5 * EVERY_S
        while (left_s := deadline - time.perf_counter()) > 0:
            if any(_tells_of(event, self._stamps_s[number]) for event in self._viewer.collect(left_s)):
                return True
        return False


def _batch(number: int, stamp_s: float) -> ObservationBatch:
    """Ten things, one of them never seen before: every batch but the first two, which only raise suspicions, is news."""
    return ObservationBatch(
        source="cam-1", boot_id="bench", seq=number, stamp_s=stamp_s, kind="cctv",
        objects=tuple(_thing(max(0, number - k)) for k in range(OBJECTS)),
    )  # fmt: skip


def _thing(number: int) -> ObjectObservation:
    place = (0.4 + 0.3 * (number % 24), 0.4 + 0.3 * (number // 24), 0.8)
    return ObjectObservation(
        track=f"t{number}", type="Mug", confidence=0.97, position_enu_m=place, covariance_m2=(1e-4, 0.0, 1e-4, 1e-4)
    )


def _tells_of(event: object, stamp_s: float) -> bool:
    message = event.message if isinstance(event, Received) else None
    return isinstance(message, WorldDelta) and any(o.stamp_s == stamp_s for o in message.objects)


def measure() -> dict[str, Any]:
    """The hub is the real process between."""
    bare: list[float] = []
    fused: list[float] = []
    with stage() as place, ExitStack() as open_ones:
        place.run("hub", "hub")
        place.child("bare_echo")
        camera, plain = (
            open_ones.enter_context(open_session(client_config(link_for(place.site, id))))
            for id in ("cctv-1", "planner")
        )
        viewer = open_ones.enter_context(node_for(place.site, "view", "view"))
        ping, observe = Ping(place, plain), Observe(place, camera, viewer)
        time.sleep(2.0)  # declarations travel on their own, and the hub starts
        for number in range(BATCHES):
            bare += _timed(ping, number)
            fused += _timed(observe, number)
    result = {"bare_round_trip": spread(bare[WARM_UP:]), "observation_to_world": spread(fused[WARM_UP:])}
    ratio = result["observation_to_world"]["median_ms"] / result["bare_round_trip"]["median_ms"]
    return {**result, "answered": len(fused), "of": BATCHES, "ratio": ratio}


def _timed(go: Callable[[int], bool], number: int) -> list[float]:
    """How long it took, or nothing when no answer came; then the rest of the pace."""
    began = time.perf_counter()
    answered = go(number)
    took_s = time.perf_counter() - began
    time.sleep(max(0.0, 0.5 * EVERY_S - took_s))
    return [took_s] if answered else []


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    parser.parse_args()
    print(json.dumps(measure(), indent=2, sort_keys=True))


if __name__ == "__main__":
    main()
