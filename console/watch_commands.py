"""demo, demo-seeds, view, record: what is looked at rather than commanded."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Annotated, Any
from urllib.parse import quote

import typer

from console.client import ClientError
from console.demo import demonstrate, summary_text
from console.mesh_commands import Drones, Json
from console.output import WordsError, emit, fail, terminal
from console.places import current_mesh, free_port
from console.viewer import quiet_environment, rerun_program
from deploy.launch import LaunchError
from wire.site import Site, SiteError, load_site


def register(app: typer.Typer) -> None:
    app.command()(demo)
    app.command("demo-seeds")(demo_seeds)
    app.command()(view)
    app.command()(record)


def demo(
    seed: Annotated[int, typer.Option(help="which generated home")] = 7,
    instruction: Annotated[str | None, typer.Option(help="instead of the scene's own task")] = None,
    out: Annotated[Path, typer.Option(help="where the results go")] = Path("out/demo"),
    limit_s: Annotated[float, typer.Option(help="give up after this many seconds")] = 600.0,
    keep: Annotated[bool, typer.Option("--keep", help="leave the mesh up afterwards")] = False,
    drones: Drones = 1,
    json_: Json = False,
) -> None:
    """Bring a home full of cameras and robots up, have one instruction done, judge it, write out/demo/."""
    try:
        summary = demonstrate(seed, out, instruction, limit_s, keep, quiet=json_, drones=drones)
    except (SiteError, LaunchError, ClientError, WordsError) as error:
        fail(str(error), json_)
    except OSError as error:
        fail(f"{error.filename}: {error.strerror}", json_)
    emit(summary, summary_text(summary, out), json_)
    if not summary["success"]:
        raise typer.Exit(1)


def demo_seeds(
    seeds: Annotated[str, typer.Option(help="FIRST-LAST")] = "0-19",
    out: Annotated[Path, typer.Option(help="one folder per seed goes here")] = Path("out/seeds"),
    limit_s: Annotated[float, typer.Option(help="give up on a seed after this many seconds")] = 400.0,
    drones: Drones = 1,
    json_: Json = False,
) -> None:
    """Run the demo on many seeds; every run is reported, failures with their reason, and written to OUT/seeds.json.

    Ctrl-C halts the robots, ends the run that it interrupts, and with it the series.
    """
    rows: list[dict[str, Any]] = []
    for seed in _range(seeds, json_):
        try:
            row = demonstrate(seed, out / str(seed), None, limit_s, keep=False, quiet=True, drones=drones)
        except (SiteError, LaunchError, ClientError) as error:
            row = {"seed": seed, "success": False, "reason": str(error), "instruction": "", "path_m": 0.0, "sim_s": 0.0}
        except OSError as error:
            fail(f"{error.filename}: {error.strerror}", json_)
        rows.append(row)
        if not json_:
            verdict = "ok  " if row["success"] else "FAIL"
            why = "" if row["success"] else row["reason"]
            terminal.print(
                f"{seed:>4} {verdict} {row['path_m']:7.1f} m {row['sim_s']:7.1f} s  {row['instruction']}  {why}",
                markup=False,
            )
        good = sum(bool(r["success"]) for r in rows)
        document = {"succeeded": good, "of": len(rows), "runs": rows}
        out.mkdir(parents=True, exist_ok=True)
        (out / "seeds.json").write_text(json.dumps(document, indent=2, sort_keys=True) + "\n")
        if row.get("task_status") == "cancelled":
            emit(document, f"interrupted: {good} of {len(rows)} seeds succeeded", json_)
            raise typer.Exit(130)
    emit(document, f"{good} of {len(rows)} seeds succeeded", json_)


def _range(seeds: str, json_: bool) -> range:
    first, _, last = seeds.partition("-")
    last = last or first
    if not (first.isdecimal() and last.isdecimal() and int(first) <= int(last)):
        fail(f"--seeds {seeds}: give FIRST-LAST, as in 0-19", json_, 2)
    return range(int(first), int(last) + 1)


def _live() -> tuple[Site, str]:
    mesh = current_mesh()
    mesh.processes()  # whether it runs
    site = load_site(mesh.site_file)
    return site, f"rerun+http://127.0.0.1:{site.view.grpc_port}/proxy"


def view(
    native: Annotated[bool, typer.Option("--native", help="a window instead of the browser")] = False,
    json_: Json = False,
) -> None:
    """Show the fused world live: in a browser (prints the address), or in a window where there is a display."""
    try:
        site, url = _live()
    except (SiteError, LaunchError) as error:
        fail(str(error), json_)
    has_display = bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    if native and not has_display:
        fail(
            "there is no display here: neither DISPLAY nor WAYLAND_DISPLAY is set; leave --native out for the browser",
            json_,
        )
    with quiet_environment() as environment:
        if native:
            raise typer.Exit(subprocess.call([rerun_program(), url], env=environment))
        port = free_port(site.view.web_port)
        page = f"http://127.0.0.1:{port}/?url={quote(url, safe='')}"
        emit({"ok": True, "page": page, "url": url}, f"open {page}\n(Ctrl-C ends the viewer, the mesh stays up)", json_)
        sys.stdout.flush()
        command = [rerun_program(), "--serve-web", "--bind", "127.0.0.1", "--web-viewer-port", str(port), url]
        try:
            raise typer.Exit(subprocess.call(command, env=environment))
        except KeyboardInterrupt:
            raise typer.Exit(0) from None


def record(
    file: Annotated[Path, typer.Argument(help="the recording to write, .rrd")],
    json_: Json = False,
) -> None:
    """Record what the view shows, from now until Ctrl-C."""
    try:
        _, url = _live()
        file.parent.mkdir(parents=True, exist_ok=True)
    except (SiteError, LaunchError) as error:
        fail(str(error), json_)
    except OSError as error:
        fail(f"{file} cannot be written: {error.strerror}", json_)
    if file.suffix != ".rrd":
        fail(f"{file}: the name of a recording ends in .rrd", json_, 2)
    if not json_:
        terminal.print(f"recording to {file} until Ctrl-C", markup=False)
    try:
        seconds = round(_record(file, url), 1)
    except RecordError as error:
        fail(str(error), json_)
    size = file.stat().st_size
    emit(
        {"ok": True, "file": str(file), "bytes": size, "seconds": seconds},
        f"wrote {file}: {size / 1e6:.1f} MB in {seconds} s",
        json_,
    )


class RecordError(RuntimeError):
    """There is no recording; the text says why."""


def _record(file: Path, url: str) -> float:
    """Record until Ctrl-C or the end of the stream; returns for how many seconds. Raises RecordError."""
    raw = file.with_suffix(".part.rrd")
    began = time.monotonic()
    with quiet_environment() as environment:
        process = subprocess.Popen(
            [rerun_program(), url, "--save", str(raw), "--bind", "127.0.0.1", "--port", "auto"],
            env=environment,
            stdout=subprocess.DEVNULL,
        )
        try:
            code = process.wait()
            took_s = time.monotonic() - began
        except KeyboardInterrupt:
            took_s = time.monotonic() - began
            process.terminate()
            code = process.wait()
        if not raw.exists():
            raise RecordError(f"nothing was recorded: does the mesh run? (rerun ended with {code})")
        # A stream that is cut has no footer; this writes it.
        whole = [rerun_program(), "rrd", "optimize", str(raw), "-o", str(file)]
        if subprocess.run(whole, check=False, capture_output=True, env=environment).returncode != 0:
            raise RecordError(f"{file} cannot be written; what was recorded lies in {raw}")
    raw.unlink()
    return took_s
