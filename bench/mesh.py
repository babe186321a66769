"""The mesh's own figures: round trips beside bare Zenoh's, a burst that must arrive whole, who notices a death when.

`python -m bench.mesh --json`
"""

import argparse
import json
import os
import signal
import statistics
import time
from typing import Any

from bench.children import BURST, PING, PONG
from bench.stage import Stage, stage
from wire.bus import Presence, Received
from wire.link import client_config, link_for
from wire.messages.world import WorldDelta
from wire.node import ZenohNode, node_for, open_session

ROUNDS = 2000


def spread(samples_s: list[float]) -> dict[str, float]:
    """Median and 99th percentile in milliseconds."""
    ordered = sorted(samples_s)
    return {
        "median_ms": 1000.0 * statistics.median(ordered),
        "p99_ms": 1000.0 * ordered[int(0.99 * (len(ordered) - 1))],
        "rounds": len(ordered),
    }


def bare_round_trip(place: Stage, pause_s: float = 0.0) -> dict[str, float]:
    """put -> sample -> put -> sample between two plain sessions through the router, one every `pause_s` at most."""
    child = place.child("bare_echo")
    with open_session(client_config(link_for(place.site, "hub"))) as session:
        answers = session.declare_subscriber(f"{place.site.realm}/{PONG}")
        ping = session.declare_publisher(f"{place.site.realm}/{PING}")
        payload = b"x" * 120
        time.sleep(0.3)  # declarations travel on their own
        samples = []
        for _ in range(ROUNDS):
            began = time.perf_counter()
            ping.put(payload)
            answers.recv()
            samples.append(time.perf_counter() - began)
            if pause_s:
                time.sleep(pause_s)
    child.kill()
    return spread(samples[50:])


def node_round_trip(place: Stage) -> dict[str, float]:
    """The same way through `Node`: codec, validation, inbox on both sides."""
    child = place.child("echo")
    with node_for(place.site, "hub", "hub") as node:
        node.subscribe("robot_report")
        time.sleep(0.3)
        samples = []
        for number in range(1, ROUNDS + 1):
            began = time.perf_counter()
            node.publish("world_delta", WorldDelta(seq=number, stamp_s=0.0))
            _wait_for_report(node)
            samples.append(time.perf_counter() - began)
    child.kill()
    return spread(samples[50:])


def _wait_for_report(node: ZenohNode) -> None:
    while not any(isinstance(e, Received) and e.topic == "robot_report" for e in node.collect(1.0)):
        pass


def burst(place: Stage) -> dict[str, float]:
    """BURST messages from one process to another as fast as they go; none may be lost, and order must hold."""
    child = place.child("burst")
    assert child.stdin is not None
    with node_for(place.site, "hub", "hub") as node:
        node.subscribe("robot_report")
        time.sleep(0.3)
        began = time.perf_counter()
        child.stdin.write("go\n")
        child.stdin.flush()
        seen, in_order, quiet_since = 0, True, time.perf_counter()
        while seen < BURST and time.perf_counter() - quiet_since < 5.0:
            for event in node.collect(0.5):
                if isinstance(event, Received):
                    in_order &= getattr(event.message, "seq", -1) == seen
                    seen += 1
                    quiet_since = time.perf_counter()
        took = time.perf_counter() - began
    child.kill()
    return {"sent": BURST, "lost": BURST - seen, "in_order": in_order, "per_s": seen / took}


def presence(place: Stage, signal_number: int, trials: int = 5) -> dict[str, float]:
    """Seconds from the signal until a watcher hears that the process has gone."""
    samples = []
    with node_for(place.site, "hub", "hub") as node:
        node.watch_presence()
        for _ in range(trials):
            child = place.child("idle")
            _wait_presence(node, alive=True)
            began = time.perf_counter()
            os.kill(child.pid, signal_number)
            _wait_presence(node, alive=False)
            samples.append(time.perf_counter() - began)
            child.kill()
            child.wait()
    return {"median_ms": 1000.0 * statistics.median(samples), "worst_ms": 1000.0 * max(samples), "trials": trials}


def _wait_presence(node: ZenohNode, alive: bool) -> None:
    deadline = time.monotonic() + 10.0
    while time.monotonic() < deadline:
        for event in node.collect(0.02):
            if isinstance(event, Presence) and event.process == "dog-1" and event.alive == alive:
                return
    raise TimeoutError("presence did not change within 10 s")


def measure() -> dict[str, Any]:
    with stage() as place:
        bare = bare_round_trip(place)
        node = node_round_trip(place)
        flood = burst(place)
        killed = presence(place, signal.SIGKILL)
        frozen = presence(place, signal.SIGSTOP, trials=3)
    return {
        "bare_round_trip": bare,
        "node_round_trip": node,
        "node_over_bare": node["median_ms"] / bare["median_ms"],
        "burst": flood,
        "kill_noticed": killed,
        "freeze_noticed": frozen,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    parser.parse_args()
    print(json.dumps(measure(), indent=2, sort_keys=True))


if __name__ == "__main__":
    main()
