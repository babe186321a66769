"""up, down, status, logs, restart, sites: the processes of a mesh."""

from pathlib import Path
from typing import Annotated

import typer

from console.bring_up import bring_up
from console.client import Client, ClientError, presence
from console.logs import show_logs
from console.output import emit, fail, terminal
from console.places import current_mesh, known_sites, prepare
from deploy.launch import LaunchError, Mesh, ProcessInfo
from wire.access import devices_of
from wire.messages.world import RobotState, SnapshotRequest, WorldState
from wire.site import Site, SiteError, load_site

Json = Annotated[bool, typer.Option("--json", help="print one JSON document instead of text")]
Drones = Annotated[int, typer.Option(help="how many drones fly in a generated home", min=0, max=4)]
LineJson = Annotated[bool, typer.Option("--json", help="print one JSON object a line instead of text")]


def register(app: typer.Typer) -> None:
    for command in (up, down, status, logs, restart, sites):
        app.command()(command)


def up(
    site: Annotated[str | None, typer.Argument(help="a site file, or a name that `sites` lists")] = None,
    seed: Annotated[int, typer.Option(help="without SITE: the generated home with this seed")] = 7,
    port: Annotated[
        int | None, typer.Option(help="of the router, instead of the site file's", min=1, max=65535)
    ] = None,
    drones: Drones = 1,
    json_: Json = False,
) -> None:
    """Start a site's mesh under supervision and wait until every process has announced itself."""
    try:
        ready = bring_up(prepare(site, seed, port, drones), quiet=json_)
    except (SiteError, LaunchError) as error:
        fail(str(error), json_, 2 if isinstance(error, SiteError) else 1)
    document = {
        "ok": True,
        "site": ready.site.name,
        "run_dir": str(ready.mesh.run_dir),
        "ready_s": round(ready.took_s, 2),
    }
    emit(document, f"{ready.site.name} is up: {len(ready.site.process)} processes in {ready.took_s:.1f} s", json_)


def down(json_: Json = False) -> None:
    """Stop the mesh: every process, then the supervisor."""
    try:
        ended = current_mesh().stop()
    except (SiteError, LaunchError) as error:
        fail(str(error), json_)
    emit(
        {"ok": True, "processes": {p.id: p.exit_code for p in ended}},
        f"stopped {len(ended)} processes",
        json_,
    )


def status(json_: Json = False) -> None:
    """Which processes run, since when, and which have announced themselves on the mesh."""
    try:
        mesh = current_mesh()
        rows = mesh.processes()
        site = load_site(mesh.site_file)
        here = _announced(mesh, site)
        flyers = _flyers(mesh, site, here)
    except (SiteError, LaunchError) as error:
        fail(str(error), json_)
    devices = device_names(site)
    wanted = {process.id for process in site.process if process.autostart}
    document = {
        "ok": all(row.state == "RUNNING" for row in rows if row.id in wanted),
        "run_dir": str(mesh.run_dir),
        "processes": [
            {
                "id": r.id,
                "device": devices.get(r.id),
                "state": r.state.lower(),
                "pid": r.pid,
                "up_s": r.up_s,
                "announced": r.id in here,
                **flight_row(flyers.get(r.id)),
            }
            for r in rows
        ],
    }
    lines = (_line(r, devices.get(r.id, ""), r.id in here) + flight_text(flyers.get(r.id)) for r in rows)
    emit(document, "\n".join(lines), json_)


def device_names(site: Site) -> dict[str, str]:
    """Process -> the camera or robot that it serves, as `why` and the view call it."""
    served = {process.id: devices_of(process) for process in site.process}
    return {process: devices[-1] for process, devices in served.items() if devices}


def _announced(mesh: Mesh, site: Site) -> set[str]:
    """Processes whose liveliness tokens are there; none when the router cannot be reached."""
    try:
        routers = {p.id for p in site.process if p.role == "router"}  # who answers at all has a router
        return presence(site, mesh.credentials_dir) | routers
    except ClientError:
        return set()


def _flyers(mesh: Mesh, site: Site, here: set[str]) -> dict[str, RobotState]:
    """The drones as the hub knows them; none where it cannot be asked."""
    rows = {robot.id for robot in site.robot if robot.kind == "drone"}
    if not rows & here:
        return {}
    try:
        with Client(site, mesh.credentials_dir) as client:
            world = client.ask("snapshot", SnapshotRequest(), WorldState, tries=1)
    except ClientError:
        return {}
    return {robot.id: robot for robot in world.robots if robot.id in rows}


def flight_row(flyer: RobotState | None) -> dict[str, float | str | None]:
    """The same for programs; None where the battery is not told. `robot`: `lost` unheard, `fault` flown by hand."""
    if flyer is None:
        return {}
    return {"height_m": round(flyer.position_enu_m[2], 2), "battery": flyer.battery, "robot": flyer.status}


def flight_text(flyer: RobotState | None) -> str:
    """How high a drone is and how full, for the end of its line; empty for everything else."""
    if flyer is None:
        return ""
    if flyer.status == "lost":
        return "  its autopilot is not heard"
    power = f"battery {flyer.battery:.0%}" if flyer.battery is not None else "battery not told"
    height = f"{flyer.position_enu_m[2]:.1f} m high" if flyer.airborne else "on the floor"
    flown = ", flown by hand" if flyer.status == "fault" else ""
    return f"  {height}, {power}{flown}"


def _line(row: ProcessInfo, device: str, announced: bool) -> str:
    since = f"{row.up_s:6.0f} s" if row.state == "RUNNING" else f"{row.text}"
    return f"{row.id:<12} {device:<10} {row.state.lower():<9} {'announced' if announced else '-':<10} {since}"


def logs(
    name: Annotated[str | None, typer.Argument(help="one process; all when left out")] = None,
    follow: Annotated[bool, typer.Option("-f", "--follow", help="go on until Ctrl-C")] = False,
    lines: Annotated[int, typer.Option("-n", help="how many past lines of each")] = 20,
    json_: LineJson = False,
) -> None:
    """Show what processes say, each line with its process's name."""
    try:
        mesh = current_mesh()
    except SiteError as error:
        fail(str(error), json_)
    files: list[Path] = sorted(mesh.log_dir.glob("*.log"))
    if name is not None:
        files = [f for f in files if f.stem == name]
        if not files:
            known = ", ".join(sorted(f.stem for f in mesh.log_dir.glob("*.log")))
            fail(f"no process '{name}' has written a log here; there are: {known}", json_)
    try:
        show_logs(files, follow, lines, json_)
    except KeyboardInterrupt:
        if not json_:
            terminal.print("")


def restart(name: Annotated[str, typer.Argument(help="the process")], json_: Json = False) -> None:
    """Stop one process and start it again."""
    try:
        current_mesh().restart(name)
    except (SiteError, LaunchError) as error:
        fail(str(error), json_)
    emit({"ok": True, "restarted": name}, f"{name} restarted", json_)


def sites(json_: Json = False) -> None:
    """List the site files that come with the project."""
    rows = []
    for path in known_sites():
        try:
            site = load_site(path)
            rows.append(
                {"name": path.stem, "rooms": len(site.room), "cameras": len(site.camera), "robots": len(site.robot)}
            )
        except SiteError as error:
            rows.append({"name": path.stem, "error": str(error)})
    text = "\n".join(
        f"{r['name']:<16} "
        + (str(r["error"]) if "error" in r else f"{r['rooms']} rooms, {r['cameras']} cameras, {r['robots']} robots")
        for r in rows
    )
    emit(
        {"sites": rows},
        text
        or "no site files in deploy/sites; `justw home --seed 7 --out my.toml` writes one, `justw up my.toml` starts it",
        json_,
    )
