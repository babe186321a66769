"""Sub-tasks in words, as prompts list them, to the steps that finish each."""

import re
from dataclasses import dataclass

from tests.ollama_double.planning.errands import Step
from tests.ollama_double.planning.prompt_text import Known
from tests.ollama_double.planning.speech import read_wishes

_LINE = re.compile(r'(\S+?)(?: by (\S+))?(?: after ([^:]*))?: "([^"]*)"(?: needs (.*))?')


@dataclass(frozen=True)
class Line:
    id: str
    robot: str
    what: str
    needs: tuple[str, ...]


def read_lines(lines: list[str]) -> list[Line]:
    """What stands under a heading for sub-tasks."""
    found = [match for line in lines if (match := _LINE.fullmatch(line.strip())) is not None]
    return [Line(m[1], m[2] or "", m[4], tuple((m[5] or "").split())) for m in found]


def steps_of(line: Line, known: Known, corrected: bool) -> list[Step]:
    """The steps of one sub-task. `corrected`: a thing that is not there is taken for one of its kind."""
    what = _mended(line.what, known) if corrected else line.what
    search = re.fullmatch(r"search (\S+) for (.*)", what)
    if search is not None:
        return [Step("explore", room=search[1], looking_for=tuple(search[2].split()))]
    through = re.fullmatch(r"go through (\S+)", what)
    if through is not None:
        return [Step("explore", room=through[1])]
    cut = re.fullmatch(r"slice (\S+) with (\S+)", what)
    if cut is not None:
        return [*_take(cut[2], line.robot, known), Step("slice", cut[1], item=cut[2]), *_lay(cut[2], cut[1], known)]
    put = re.fullmatch(r"put (\S+) in (\S+)", what)
    if put is not None:
        return [*_take(put[1], line.robot, known), Step("put", put[2], item=put[1])]
    simple = re.fullmatch(r"(open|close|clean|look at|switch on|switch off) (\S+)", what)
    if simple is not None:
        do = {"look at": "inspect", "switch on": "toggle_on", "switch off": "toggle_off"}.get(simple[1], simple[1])
        return [Step(do, simple[2])]
    return [Step(w.verb, w.what.name) for w in read_wishes(what, known).wanted if w.what.name][:1]


def _take(name: str, robot: str, known: Known) -> list[Step]:
    held = any(r.holds == name and r.name in (robot, r.name if not robot else "") for r in known.robots.values())
    return [] if held else [Step("pickup", name)]


def _lay(name: str, beside: str, known: Known) -> list[Step]:
    thing = known.things.get(beside)
    return [Step("put", thing.holder.name, item=name)] if thing is not None and thing.holder is not None else []


def _mended(what: str, known: Known) -> str:
    """Names that are not there, exchanged for those of things of the same word."""
    for name in re.findall(r"\b[a-z]+\d+\b", what):
        if name not in known.things:
            alike = next((t.name for t in known.things.values() if t.word == name.rstrip("0123456789")), name)
            what = what.replace(name, alike)
    return what
