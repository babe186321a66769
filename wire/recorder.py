"""Records what is published on a mesh, and plays it to a core again.

`python -m wire.recorder --site FILE --id recorder --out FILE` records every topic that a view may hear, until stopped.
"""

import argparse
import logging
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

from wire.bus import Core
from wire.clock import WallClock
from wire.keys import TOPICS, Role
from wire.letter import NO_TICK, Kind, Letter
from wire.link import MeshError, link_for
from wire.loopback import LoopbackMesh
from wire.node import ZenohNode
from wire.paths import id_in, key
from wire.process import EXIT_FAULT, EXIT_USAGE, StopFlag, die_with_parent, set_up_logging, stop_with
from wire.recording import Record, RecordingError, RecordingWriter
from wire.site import Site, SiteError, load_site

log = logging.getLogger("recorder")


def record(node: ZenohNode, writer: RecordingWriter, step_s: float, stopping: Callable[[], bool]) -> int:
    """Write down what arrives until `stopping`; returns how many messages that were.

    The time of a record is that of its tick in lockstep, else the wall's.
    """
    clock, count = WallClock(), 0
    paths = {topic.name: topic.path for topic in TOPICS}
    for topic in TOPICS:
        if node.role in topic.subscribers:
            node.subscribe(topic.name)
    while not stopping():
        for letter in node.inbox.take(0.2):
            if letter.kind is Kind.MESSAGE:
                now_s = clock.now_s() if letter.tick == NO_TICK else letter.tick * step_s
                writer.write(
                    now_s, key("", paths[letter.name], letter.id)[1:], letter.sender, letter.tick, letter.payload
                )
                count += 1
    return count


def replay_into(
    core: Core, id: str, role: Role, records: Iterable[Record], step_s: float, owner: str = ""
) -> list[Record]:
    """Hand a core what was recorded, as the process `id`, tick by tick; returns what it published."""
    said: list[Record] = []
    mesh = LoopbackMesh(step_s, lambda *row: said.append(Record(*row)), owner)
    mesh.add(core, id, role)
    heard = [letter for number, row in enumerate(records) if (letter := _letter(row, number)) is not None]
    for letter in heard:
        mesh.inject(letter)
    for _ in range(max((letter.tick for letter in heard), default=-1) + 1):
        mesh.tick()
    mesh.close()
    return said


def _letter(row: Record, number: int) -> Letter | None:
    for topic in TOPICS:
        id = id_in("", topic.path, f"/{row.key}")
        if id is not None:
            return Letter(Kind.MESSAGE, topic.name, id, row.sender, row.tick, number, row.payload)
    return None


def run(site: Site, process: str, out: Path, stopping: Callable[[], bool]) -> None:
    with ZenohNode(link_for(site, process), process, "view", keep_all=True) as node, RecordingWriter(out) as writer:
        log.info("recording into %s", out)
        log.info("%d messages in %s", record(node, writer, site.clock.step_s, stopping), out)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--site", type=Path, required=True, help="the site file (TOML)")
    parser.add_argument("--id", default="recorder")
    parser.add_argument("--out", type=Path, required=True, help="the recording; an existing one is carried on")
    arguments = parser.parse_args()
    set_up_logging()
    stopping = StopFlag()
    stopping.install()
    die_with_parent()
    try:
        run(load_site(arguments.site), arguments.id, arguments.out, stopping)
    except SiteError as error:
        stop_with(EXIT_USAGE, error)
    except (MeshError, RecordingError, OSError) as error:
        stop_with(EXIT_FAULT, error)
    sys.exit(0)


if __name__ == "__main__":
    main()
