"""What in a site file contradicts itself or the building: one sentence for each fault, with its place and the remedy."""

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from wire.airlink import link_fault
from wire.catalogue import PROP_FLAG, REPORTED, SMART_TYPES, catalogue
from wire.outline import inside

if TYPE_CHECKING:
    from wire.site import Camera, Door, Fault, Process, Robot, Room, Site


def site_faults(site: "Site") -> Iterator[str]:
    """Every fault that no single field shows."""
    yield from _repeated_ids(site)
    yield from _unknown_rooms(site)
    yield from _lost_robots(site)
    yield from _bad_ports(site)
    yield from _no_owner(site)
    yield from _bad_links(site)
    yield from _vain_faults(site)
    yield from _blind_cameras(site)


def _blind_cameras(site: "Site") -> Iterator[str]:
    for number, camera in enumerate(site.camera):
        if camera.perception != "embedded" and not site.planner.vision:
            yield (
                f"camera.{number}.perception: {camera.perception} needs a vision model; "
                "name one in planner.vision, or set embedded"
            )


def _repeated_ids(site: "Site") -> Iterator[str]:
    tables: dict[str, Iterable[Room | Door | Camera | Robot | Process]] = {
        "room": site.room,
        "door": site.door,
        "camera": site.camera,
        "robot": site.robot,
        "process": site.process,
    }
    for table, rows in tables.items():
        counts = Counter(row.id for row in rows)
        yield from (
            f"{table}: the id {id} stands there {n} times, give each its own" for id, n in counts.items() if n > 1
        )


def _unknown_rooms(site: "Site") -> Iterator[str]:
    known = {room.id for room in site.room}
    named = [(f"door.{i}.rooms", room) for i, door in enumerate(site.door) for room in door.rooms]
    named += [(f"camera.{i}.room", camera.room) for i, camera in enumerate(site.camera) if camera.room is not None]
    for place, room in named:
        if room not in known:
            yield f"{place}: there is no room {room}; the rooms are {', '.join(sorted(known))}"


def _lost_robots(site: "Site") -> Iterator[str]:
    for i, robot in enumerate(site.robot):
        if not any(inside(robot.start_m, room.polygon_m) for room in site.room):
            x_m, y_m = robot.start_m
            yield f"robot.{i}.start_m: ({x_m:g}, {y_m:g}) m is in no room; give metres east and north inside of one"


def _bad_ports(site: "Site") -> Iterator[str]:
    router = int(site.router.endpoint.rpartition(":")[2])
    if not 0 < router < 65536:
        yield f"router.endpoint: {router} is no port; give 1 to 65535"
    for number, station in enumerate(site.sim.mavlink_out if site.sim is not None else ()):
        port = int(station.rpartition(":")[2])
        if not 0 < port < 65536:
            yield f"sim.mavlink_out.{number}: {port} is no port; give 1 to 65535"
    ports = {"router.endpoint": router, "view.grpc_port": site.view.grpc_port, "view.web_port": site.view.web_port}
    counts = Counter(ports.values())
    shared = [place for place, port in ports.items() if counts[port] > 1]
    if shared:
        yield f"{' and '.join(shared)}: the same port {ports[shared[0]]}, give each its own"


def _no_owner(site: "Site") -> Iterator[str]:
    told = "mode" in site.clock.model_fields_set and site.clock.mode == "lockstep"
    if told and all(process.role != "sim" for process in site.process):
        yield "clock.mode: lockstep needs a process with the role sim, which owns the time; add one, or set wall"


def _bad_links(site: "Site") -> Iterator[str]:
    for number, robot in enumerate(site.robot):
        if fault := link_fault(robot.id, robot.kind, robot.link):
            yield f"robot.{number}.link: {fault}"
    rows = Counter(robot.link for robot in site.robot if robot.link is not None)
    for link, count in rows.items():
        if count > 1:
            yield f"robot: the link {link} stands there {count} times, give each drone its own"


def _vain_faults(site: "Site") -> Iterator[str]:
    """Faults that would never happen: a typo in an experiment is otherwise taken for robustness."""
    if site.sim is None:
        return
    seeing = sorted({camera.id for camera in site.camera} | {robot.id for robot in site.robot})
    for number, fault in enumerate(site.sim.fault):
        place = f"sim.fault.{number}"
        if fault.kind == "wrong_state":
            yield from _vain_wrong_state(fault, place, site.sim.smart_appliances)
        elif fault.device not in seeing:
            yield f"{place}.device: {fault.device} takes no pictures; those that do are {', '.join(seeing) or 'none'}"
        elif fault.kind == "delay" and fault.delay_s == 0.0:
            yield f"{place}.delay_s: a delay needs a time above 0 s"


def _vain_wrong_state(fault: "Fault", place: str, smart: bool) -> Iterator[str]:
    type, _, number = fault.device.rpartition("-")
    kinds = {name.lower(): name for name in SMART_TYPES}
    if not smart:
        yield f"{place}.kind: no appliance reports its state here; set sim.smart_appliances = true"
    if type not in kinds or not number.isdecimal():
        names = ", ".join(f"{kind}-1" for kind in kinds)
        yield f"{place}.device: {fault.device} reports no state; appliances are called {names} and so on"
        return
    reported = [prop for prop in REPORTED if catalogue()[kinds[type]].can(PROP_FLAG[prop])]
    if fault.prop is not None and fault.prop not in reported:
        yield f"{place}.prop: {fault.device} does not report {fault.prop}; it reports {', '.join(reported)}"
