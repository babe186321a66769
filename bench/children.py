"""The other ends of the mesh measurements, each a process of its own: `python -m bench.children NAME --site FILE`."""

import argparse
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path

from wire.bus import Received
from wire.link import LEAN_RUNTIME, client_config, link_for
from wire.messages.command import RobotReport
from wire.messages.world import WorldDelta
from wire.node import node_for, open_session
from wire.site import Site, load_site

BURST = 200_000
PING, PONG = "bench/ping", "bench/pong"
TICK, DONE = "bench/tick", "bench/done"


def ready() -> None:
    print("ready", flush=True)


def bare_echo(site: Site) -> None:
    """Answers every sample with its payload, over a plain session: the floor under every latency."""
    with open_session(client_config(link_for(site, "dog-1"))) as session:
        pong = session.declare_publisher(f"{site.realm}/{PONG}")
        session.declare_subscriber(f"{site.realm}/{PING}", lambda sample: pong.put(sample.payload.to_bytes()))
        ready()
        sys.stdin.read()


def bare_follower(site: Site) -> None:
    """Answers every tick of an empty clock, over a plain session, one thread, nothing else: the floor under lockstep."""
    with open_session(client_config(link_for(site, "dog-1")), LEAN_RUNTIME) as session:
        done = session.declare_publisher(f"{site.realm}/{DONE}/{os.getpid()}")
        ticks = session.declare_subscriber(f"{site.realm}/{TICK}")
        ready()
        for sample in ticks:
            done.put(sample.payload)


def echo(site: Site) -> None:
    """Answers every WorldDelta with a RobotReport of the same number, through node, codec and validation."""
    with node_for(site, "dog-1", "robot") as node:
        node.subscribe("world_delta")
        node.announce()
        ready()
        while True:
            for event in node.collect(1.0):
                if isinstance(event, Received) and isinstance(event.message, WorldDelta):
                    node.publish("robot_report", report(event.message.seq), "dog-1")


def burst(site: Site) -> None:
    """Sends BURST messages as fast as it can, when told to."""
    with node_for(site, "dog-1", "robot") as node:
        node.announce()
        ready()
        sys.stdin.readline()
        message = report(0)
        for number in range(BURST):
            node.publish("robot_report", message.model_copy(update={"seq": number}), "dog-1")
        print("sent", flush=True)
        sys.stdin.read()


def idle(site: Site) -> None:
    """Is there, and nothing else."""
    with node_for(site, "dog-1", "robot") as node:
        node.announce()
        ready()
        while True:
            time.sleep(1.0)


def report(seq: int) -> RobotReport:
    return RobotReport(
        robot="dog-1", seq=seq, stamp_s=0.0, position_enu_m=(1.0, 2.0, 0.0), yaw_rad=0.5, status="idle",
        path_m=((1.0, 2.0), (3.0, 4.0)),
    )  # fmt: skip


CHILDREN: dict[str, Callable[[Site], None]] = {
    "bare_echo": bare_echo, "bare_follower": bare_follower, "echo": echo, "burst": burst, "idle": idle,
}  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("name", choices=sorted(CHILDREN))
    parser.add_argument("--site", type=Path, required=True)
    arguments = parser.parse_args()
    CHILDREN[arguments.name](load_site(arguments.site))


if __name__ == "__main__":
    main()
