"""task, why, stop, pause, resume, cancel: what an operator asks of the hub."""

from typing import Annotated

import typer

from console.client import Client, ClientError
from console.mesh_commands import Json
from console.output import WordsError, checked, emit, fail
from console.places import current_mesh
from console.task import run_task, task_document, task_text
from deploy.launch import LaunchError
from wire.messages.operator import Claim, ControlReply, ControlRequest, WhyReply, WhyRequest
from wire.site import SiteError, load_site

FAULTS = (SiteError, LaunchError, ClientError, WordsError)


def register(app: typer.Typer) -> None:
    for command in (task, why, stop, pause, resume, cancel):
        app.command()(command)


def open_client() -> Client:
    """A client of the current mesh. Raises SiteError, LaunchError where none runs."""
    mesh = current_mesh()
    mesh.processes()  # whether it runs: a router that is not there would be blamed on its passwords
    return Client(load_site(mesh.site_file), mesh.credentials_dir)


def task(
    instruction: Annotated[str, typer.Argument(help="what is to be done, in plain words")],
    limit_s: Annotated[float, typer.Option(help="give up waiting after this many seconds")] = 900.0,
    json_: Json = False,
) -> None:
    """Have something done; shows progress, ends with what was done. Ctrl-C cancels the task."""
    try:
        with open_client() as client:
            final = run_task(client, instruction, limit_s, quiet=json_)
    except FAULTS as error:
        fail(str(error), json_)
    emit(task_document(final), task_text(final), json_)
    if final.status != "done":
        raise typer.Exit(1)


def why(thing: Annotated[str, typer.Argument(help="an object: words or its id")], json_: Json = False) -> None:
    """Say where a thing is believed to be, who said so, when, how sure, and who contradicted."""
    try:
        with open_client() as client:
            reply = client.ask("why", checked(WhyRequest, object=thing), WhyReply)
    except FAULTS as error:
        fail(str(error), json_)
    emit(reply.model_dump(mode="json"), why_text(reply), json_)
    if not reply.entries and reply.robot is None:
        raise typer.Exit(1)


def why_text(reply: WhyReply) -> str:
    """Each thing's sentence, and under it every source's claim; how many were left out; the text of the answer
    when there is no thing."""
    lines: list[str] = []
    for entry in reply.entries:
        lines += [entry.text, *(_claim_text(claim, reply.now_s) for claim in entry.claims)]
    if reply.more:
        lines.append(f'and {reply.more} more; an id or a room narrows it down: `justw why "mug in the kitchen"`')
    return "\n".join(lines) or reply.text


def _claim_text(claim: Claim, now_s: float) -> str:
    age_s = max(now_s - claim.stamp_s, 0.0)
    mark = "CONTRADICTS " if claim.contradicts else ""
    return f"  {mark}{claim.source}: {claim.text}, {100.0 * claim.confidence:.0f} % sure, {age_s:.0f} s ago"


def _control(verb: str, json_: bool, task: str | None = None) -> None:
    try:
        request = checked(ControlRequest, verb=verb, task=task)
        with open_client() as client:
            reply = client.ask("control", request, ControlReply)
    except FAULTS as error:
        fail(str(error), json_)
    if not reply.ok:
        fail(reply.text, json_)
    emit({"ok": True, "text": reply.text}, reply.text, json_)


def stop(json_: Json = False) -> None:
    """Halt every robot at once and cancel all tasks."""
    _control("stop", json_)


def pause(json_: Json = False) -> None:
    """Halt the robots and keep the tasks."""
    _control("pause", json_)


def resume(json_: Json = False) -> None:
    """Go on after a pause."""
    _control("resume", json_)


def cancel(task: Annotated[str, typer.Argument(help="the task's id")], json_: Json = False) -> None:
    """Cancel one task."""
    _control("cancel", json_, task)
