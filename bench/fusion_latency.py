"""From an observation on the wire to the world state decoded at a subscriber, beside bare Zenoh's round trip.

`python -m bench.fusion_latency --json`
"""

import argparse
import json
import time
from typing import Any

from bench.mesh import bare_round_trip, spread
from bench.stage import Stage, stage
from wire.bus import Received
from wire.messages.observation import ObjectObservation, ObservationBatch
from wire.messages.world import WorldDelta
from wire.node import ZenohNode, node_for

BATCHES = 400
EVERY_S = 0.05
OBJECTS = 10


def _batch(number: int) -> ObservationBatch:
    """Ten things, one of them never seen before, so that every batch changes the world."""
    return ObservationBatch(
        source="cam-1", boot_id="bench", seq=number, stamp_s=number * EVERY_S, kind="cctv",
        objects=tuple(_thing(max(0, number - k)) for k in range(OBJECTS)),
    )  # fmt: skip


def _thing(number: int) -> ObjectObservation:
    place = (0.4 + 0.3 * (number % 24), 0.4 + 0.3 * (number // 24), 0.8)
    return ObjectObservation(
        track=f"t{number}", type="Mug", confidence=0.97, position_enu_m=place, covariance_m2=(1e-4, 0.0, 1e-4, 1e-4)
    )


def observation_to_world(place: Stage) -> dict[str, float]:
    """Publish as a camera, wait as a viewer; the hub is the real process between."""
    place.run("hub", "hub")
    with node_for(place.site, "cctv-1", "cctv") as camera, node_for(place.site, "view", "view") as viewer:
        viewer.subscribe("world_delta")
        camera.announce()
        samples: list[float] = []
        answered = 0
        for number in range(BATCHES):
            began = time.perf_counter()
            camera.publish("observation", _batch(number), "cam-1")
            if _wait_for_objects(viewer, EVERY_S):
                answered += 1
                samples.append(time.perf_counter() - began)
            left_s = EVERY_S - (time.perf_counter() - began)
            if left_s > 0:
                time.sleep(left_s)  # paced: a hot loop would hide the wake-ups
    return {**spread(samples[20:]), "answered": answered, "of": BATCHES}


def _wait_for_objects(viewer: ZenohNode, limit_s: float) -> bool:
    deadline = time.perf_counter() + limit_s
    while (left_s := deadline - time.perf_counter()) > 0:
        for event in viewer.collect(left_s):
            if isinstance(event, Received) and isinstance(event.message, WorldDelta) and event.message.objects:
                return True
    return False


def measure() -> dict[str, Any]:
    with stage() as place:
        bare = bare_round_trip(place, pause_s=0.005)
        fused = observation_to_world(place)
    return {"bare_round_trip": bare, "observation_to_world": fused, "ratio": fused["median_ms"] / bare["median_ms"]}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    parser.parse_args()
    print(json.dumps(measure(), indent=2, sort_keys=True))


if __name__ == "__main__":
    main()
