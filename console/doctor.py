"""What a site needs of this machine, check by check: is it there, and if not, which command brings it."""

import os
import platform
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from deploy.modules import missing_modules
from deploy.ports import taken_ports
from wire.planner_table import PlannerChoice
from wire.site import Site

if TYPE_CHECKING:
    from planners.model_inspection import ServerState

_PYTHON = (3, 11)
_TRY_OPENGL = "from sim.render.choose import TRIAL; exec(TRIAL)"
_OPENGL_S = 60.0
State = Literal["ok", "missing", "without"]
"""`without`: it is not there, and the site does without it."""


@dataclass(frozen=True)
class Check:
    """One thing looked at."""

    name: str
    state: State
    text: str
    remedy: str = ""
    """A command, or what to change."""


def checks(site: Site, load: bool = False) -> Iterator[Check]:
    """Everything for a site; each check is made when it is asked for. `load`: have its language models loaded."""
    yield _python()
    yield _modules(site)
    yield _ports(site)
    yield _opengl(site)
    yield _display()
    yield from _planner(site, load)


def _python() -> Check:
    found = platform.python_version()
    if sys.version_info[:2] == _PYTHON:
        return Check("python", "ok", found)
    wanted = ".".join(map(str, _PYTHON))
    return Check("python", "missing", f"this is {found}, R2X needs {wanted}", f"install Python {wanted}, remove .venv/")


def _modules(site: Site) -> Check:
    fault = missing_modules(site)
    return Check("modules", "missing", fault) if fault else Check("modules", "ok", "every process has its module")


def _ports(site: Site) -> Check:
    taken = taken_ports(site)
    if not taken:
        return Check("ports", "ok", "free")
    if f"taken by the mesh of {site.name}," in taken:
        return Check("ports", "ok", f"the mesh of {site.name} has them: it runs")
    what, _, remedy = taken.partition("; stop that")
    return Check("ports", "missing", what, f"stop that{remedy}")


def _opengl(site: Site) -> Check:
    if site.sim is None or site.sim.renderer in ("bullet", "none"):
        return Check("opengl", "ok", "nothing of this site is drawn with OpenGL")
    command = [sys.executable, "-c", _TRY_OPENGL]
    try:
        tried = subprocess.run(command, capture_output=True, timeout=_OPENGL_S, check=False).returncode == 0
    except subprocess.TimeoutExpired:
        tried = False
    if tried:
        return Check("opengl", "ok", "starts without a display (EGL)")
    remedy = "sudo apt-get install libegl1 libgl1-mesa-dri"
    if site.sim.renderer == "gl":
        return Check("opengl", "missing", "does not start, and sim.renderer asks for it", remedy)
    return Check(
        "opengl", "without", "does not start: cameras of the simulator are drawn slower, without lamps", remedy
    )


def _display() -> Check:
    if os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"):
        return Check("display", "ok", "there: `justw view --native` opens a window")
    return Check("display", "without", "none: `justw view` shows the mesh in a browser")


def _planner(site: Site, load: bool) -> Iterator[Check]:
    from planners.modelled import has_model
    from planners.opening import missing_client
    from planners.planner import PLANNERS  # the grammar comes with it, which no other command needs

    choice = site.planner
    if choice.name not in PLANNERS:
        yield Check("planner", "missing", f"there is no {choice.name!r}", f"planner.name: {', '.join(PLANNERS)}")
        return
    asked = [choice.model] if has_model(PLANNERS[choice.name]) else []
    asked += [choice.vision] if choice.vision and choice.vision not in asked else []
    if not asked:
        yield Check("planner", "ok", f"{choice.name} needs no language model")
    elif choice.replies == "only":
        yield Check("planner", "ok", f"{choice.name} has kept replies of {' and '.join(asked)} and asks no server")
    elif fault := missing_client():
        yield Check("planner", "missing", fault)
    else:
        yield Check("planner", "ok", f"{choice.name}{f', with {choice.vision} for pictures' if choice.vision else ''}")
        yield from server_checks(choice, asked, load)


def server_checks(choice: PlannerChoice, models: list[str], load: bool) -> Iterator[Check]:
    """The model server: does it run, has it the models, what can they do, and how long is their context really."""
    from planners.model_inspection import inspect

    state = inspect(choice)
    if not state.answers:
        yield Check("server", "missing", state.fault.text if state.fault else "", _serve(state.host))
        return
    yield Check("server", "ok", f"answers at {state.host}, with {', '.join(state.pulled) or 'no model yet'}")
    for name in models:
        one = choice.model_copy(update={"model": name})
        yield from _model_checks(one, inspect(one, load), load, must_see=name == choice.vision)


def _model_checks(choice: PlannerChoice, state: "ServerState", load: bool, must_see: bool) -> Iterator[Check]:
    if state.facts is None:
        why = state.fault.text if state.fault is not None else ""
        pulled = {choice.model, f"{choice.model}:latest"} & set(state.pulled)
        remedy = "the server's own log tells more" if pulled else f"ollama pull {choice.model}"
        yield Check("model", "missing", f"{choice.model}: {why}", remedy)
        return
    can = ", ".join(sorted(state.facts.capabilities)) or "nothing that it says"
    what = "a stand-in without a model that claims" if state.facts.stand_in else "is there; it has"
    if must_see and "vision" not in state.facts.capabilities:
        text = f"{choice.model} cannot look at pictures: it has {can}"
        yield Check("model", "missing", text, "set planner.vision to a model with the capability `vision`")
        return
    yield Check("model", "ok", f"{choice.model}: {what} {can}")
    yield _context(choice, state.context, state.facts.longest_context, load)


def _serve(host: str) -> str:
    """The command that starts a server where this one is looked for."""
    if not any(name in host for name in ("127.0.0.1", "localhost", "[::1]")):
        return f"on the machine of {host}: ollama serve"
    return "ollama serve" if host.endswith(":11434") else f"OLLAMA_HOST={host} ollama serve"


def _context(choice: PlannerChoice, context: int | None, longest: int | None, loaded: bool) -> Check:
    """A shorter context than was asked for cuts prompts without a word."""
    wanted = choice.num_ctx
    if longest is not None and longest < wanted:
        text = f"the model has {longest} tokens at most, planner.num_ctx asks for {wanted}"
        return Check("context", "missing", text, f"set planner.num_ctx = {longest}")
    if context is None:
        return Check("context", "ok", f"{wanted} tokens will be asked for; the model is loaded when the planner starts")
    if context < wanted and not loaded:
        text = (
            f"{context} tokens are loaded, planner.num_ctx asks for {wanted}: another program may have asked for fewer"
        )
        return Check("context", "without", text, "`justw doctor --load` asks the server for all of them")
    if context < wanted:
        text = f"the server gave {context} tokens, planner.num_ctx asks for {wanted}: longer prompts are cut"
        return Check("context", "missing", text, f"free memory for it, or set planner.num_ctx = {context}")
    more = "" if context == wanted else f", {context} are loaded: it will be loaded anew"
    return Check("context", "ok", f"{wanted} tokens{more}")
