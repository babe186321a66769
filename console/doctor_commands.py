"""doctor: does this machine have what a site needs."""

from pathlib import Path
from typing import Annotated, Any

import typer

from console.doctor import Check, checks
from console.mesh_commands import Json
from console.output import emit, fail
from console.places import current_mesh, named_site
from wire.site import Site, SiteError, load_site

DEFAULT_SITE = "home"
"""Whoever has not started anything yet begins with this one."""


def register(app: typer.Typer) -> None:
    app.command()(doctor)


def doctor(
    site: Annotated[str | None, typer.Argument(help="a site file, or a name that `sites` lists")] = None,
    load: Annotated[
        bool, typer.Option("--load", help="have language models loaded, to see what they really get")
    ] = False,
    json_: Json = False,
) -> None:
    """Look for everything that the site needs of this machine; says which command brings what is missing."""
    try:
        found = _site(site)
    except SiteError as error:
        fail(str(error), json_, 2)
    rows = list(checks(found, load))
    emit(doctor_document(found, rows), doctor_text(found, rows), json_)
    if any(row.state == "missing" for row in rows):
        raise typer.Exit(1)


def _site(name: str | None) -> Site:
    """The one named, that of the current mesh, or the one that comes with the project."""
    if name is not None:
        return load_site(named_site(name))
    try:
        file: Path = current_mesh().site_file
    except SiteError:
        file = named_site(DEFAULT_SITE)
    return load_site(file)


def doctor_document(site: Site, rows: list[Check]) -> dict[str, Any]:
    checked = [{"name": r.name, "state": r.state, "text": r.text, "remedy": r.remedy or None} for r in rows]
    return {"ok": all(row.state != "missing" for row in rows), "site": site.name, "checks": checked}


def doctor_text(site: Site, rows: list[Check]) -> str:
    """A line for each check, and under what is not there what to do."""
    lines = [f"{site.name}:"]
    for row in rows:
        lines.append(f"  {row.state if row.state != 'missing' else 'MISSING':<8} {row.name:<8} {row.text}")
        if row.remedy:
            lines.append(f"  {'':<8} {'':<8} -> {row.remedy}")
    missing = [row.name for row in rows if row.state == "missing"]
    lines.append(f"missing: {', '.join(missing)}" if missing else "everything that it needs is there")
    return "\n".join(lines)
