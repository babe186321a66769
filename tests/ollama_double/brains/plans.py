"""The emulated planner for every question of the planners whose plans a model writes.

It knows what stands in the prompt, and what things are called; it is handed nothing else.
"""

import json
import re
from collections.abc import Callable

from tests.ollama_double.brain import Brain, ChatRequest
from tests.ollama_double.dials import Dials
from tests.ollama_double.planning.errands import Errand, Step, Thinker, Work
from tests.ollama_double.planning.prompt_text import Known, read_known, sections
from tests.ollama_double.planning.slips import Row, Slips
from tests.ollama_double.planning.speech import read_wishes
from tests.ollama_double.planning.subtask_text import read_lines, steps_of
from tests.ollama_double.planning.team import share_out

Sections = dict[str, list[str]]


def knows(request: ChatRequest) -> bool:
    return _answerer(request) is not None


def make(dials: Dials) -> Brain:
    return Planner(dials)


def _answerer(request: ChatRequest) -> "Callable[[Planner, ChatRequest, Sections], object] | None":
    return next((answer for words, answer in PURPOSES.items() if request.system.startswith(words)), None)


class Planner:
    """See tests.ollama_double.brain.Brain."""

    def __init__(self, dials: Dials) -> None:
        self._dials = dials

    def reply(self, request: ChatRequest) -> str:
        answer = _answerer(request)
        said = answer(self, request, sections(request.user)) if answer is not None else {}
        return json.dumps(said, separators=(",", ":"))

    def _slips(self, request: ChatRequest) -> Slips:
        return Slips(self._dials, request)

    def _work(self, request: ChatRequest, parts: Sections, known: Known) -> Work:
        """Everything that the task of the prompt asks for, with a robot for each errand."""
        instruction = " ".join(parts.get("task", [""])).strip('"')
        slips = self._slips(request)
        wishes = read_wishes(instruction, known, not slips.happens("dropped_negation"))
        slips.wishes(wishes.wanted)
        work = Thinker(known, wishes).work()
        share_out(work.errands, known)
        return work

    def plan(self, request: ChatRequest, parts: Sections) -> object:
        work = self._work(request, parts, read_known(parts))
        last = _last_steps(work.errands)
        rows: list[Row] = []
        for number, errand in enumerate(work.errands):
            for place, step in enumerate(errand.steps):
                after = [last[i] for i in step.waits]
                after += [f"s{_number(work.errands, number, place - 1)}"] if place else []
                rows.append(
                    {"id": f"s{_number(work.errands, number, place)}", **_step(step), **_by(errand), "after": after}
                )
        self._slips(request).steps(rows)
        return _document("steps", rows, work)

    def decompose(self, request: ChatRequest, parts: Sections) -> object:
        work = self._work(request, parts, read_known(parts))
        rows = [{**_subtask(i, errand), **_by(errand)} for i, errand in enumerate(work.errands)]
        self._slips(request).subtasks(rows)
        return _document("subtasks", rows, work)

    def functions(self, request: ChatRequest, parts: Sections) -> object:
        known, rows = read_known(parts), list[Row]()
        for line in read_lines(parts.get("sub-tasks", [])):
            for step in steps_of(line, known, "that cannot be used" in parts):
                rows.append({"subtask": line.id, "id": f"s{len(rows) + 1}", **_step(step)})
        self._slips(request).steps(rows)
        return {"steps": rows}

    def sequences(self, request: ChatRequest, parts: Sections) -> object:
        """Sub-tasks with their steps, without robots."""
        work = self._work(request, parts, read_known(parts))
        rows = [
            {**_subtask(i, errand), "steps": [_step(s) for s in errand.steps]} for i, errand in enumerate(work.errands)
        ]
        slips = self._slips(request)
        slips.steps([step for errand in rows for step in errand["steps"]])  # type: ignore[attr-defined]
        return _document("subtasks", rows, work)

    def coalitions(self, request: ChatRequest, parts: Sections) -> object:
        known = read_known(parts)
        rows: list[Row] = [
            {"subtask": line.id, "robots": [r.name for r in known.robots.values() if set(line.needs) <= r.skills]}
            for line in read_lines(parts.get("sub-tasks", []))
        ]
        self._slips(request).table(rows, list(known.robots))
        return {"coalitions": rows}

    def allocation(self, request: ChatRequest, parts: Sections) -> object:
        able = {
            id.strip(): names.split(" or ")
            for id, _, names in (line.partition(": ") for line in parts.get("who can", []))
        }
        load = {name: 0 for names in able.values() for name in names}
        rows: list[Row] = []
        for line in read_lines(parts.get("sub-tasks", [])):
            robot = min(able.get(line.id, []), key=lambda name: (load[name], name), default="")
            load[robot] = load.get(robot, 0) + len(line.needs) + 2 * ("explore" in line.needs)
            rows.append({"subtask": line.id, "robot": robot})
        self._slips(request).table(rows, sorted(load))
        return {"allocation": rows}

    def resume(self, request: ChatRequest, parts: Sections) -> object:
        skills = [line.partition("(")[0] for line in parts.get("skills", [])]
        flies = "take_off" in skills
        seeing = [s for s in skills if s in ("explore", "inspect", "look_at", "inspect_from_above", "construct_map")]
        moving = [s for s in skills if s in ("goto", "take_off", "land", "hold", "orbit", "follow_path")]
        handling = [s for s in skills if s not in seeing and s not in moving]
        return {
            "mobility": f"{'flies' if flies else 'walks'}: {' '.join(moving)}",
            "perception": " ".join(seeing) or "none",
            "manipulation": " ".join(handling) or "none",
            "limits": "touches nothing" if flies else "stays on the floor, one hand",
        }

    def reflect(self, request: ChatRequest, parts: Sections) -> object:
        words = {w for line in parts.get("your resume", []) for w in re.findall(r"[a-z]+(?:_[a-z]+)*", line)}
        for line in read_lines(parts.get("proposed for you", [])):
            lacks = [s.do for s in steps_of(line, Known(), False) if s.do not in words]
            if lacks:
                return {"agree": False, "why": f"{line.id} takes {lacks[0]}, which I cannot"}
        return {"agree": True}

    def same(self, request: ChatRequest, parts: Sections) -> object:
        pairs = [re.fullmatch(r"(\S+) (\S+): ([\d.]+) m apart", line) for line in parts.get("may be the same", [])]
        near = [(m[1], m[2]) for m in pairs if m is not None and float(m[3]) <= 0.6]
        rows: list[Row] = [{"names": [a, b], "why": "same type, near each other"} for a, b in near]
        return {"same": rows}


PURPOSES: dict[str, Callable[[Planner, ChatRequest, Sections], object]] = {
    "You plan for a team of robots": Planner.plan,
    "You break a task down for a team": Planner.decompose,
    "You choose motion functions": Planner.functions,
    "You make one map": Planner.same,
    "You break a task down into sub-tasks": Planner.sequences,
    "You form coalitions": Planner.coalitions,
    "You allocate sub-tasks": Planner.allocation,
    "You write the resume": Planner.resume,
    "You lead a discussion": Planner.decompose,
    "You are one robot of a team. Check": Planner.reflect,
    "You are one robot of a team and act": Planner.functions,
}
"""How each system prompt begins."""


def _step(step: Step) -> Row:
    fields = {"object": step.object, "item": step.item, "room": step.room, "looking_for": list(step.looking_for)}
    return {"do": step.do, **{key: value for key, value in fields.items() if value}}


def _by(errand: Errand) -> Row:
    return {"robot": errand.robot} if errand.robot else {}


def _subtask(index: int, errand: Errand) -> Row:
    return {"id": f"t{index + 1}", "what": errand.what, "after": [f"t{i + 1}" for i in errand.waits]}


def _number(errands: list[Errand], number: int, place: int) -> int:
    return sum(len(e.steps) for e in errands[:number]) + place + 1


def _last_steps(errands: list[Errand]) -> list[str]:
    """The id of each errand's last step."""
    return [f"s{_number(errands, i, len(e.steps) - 1)}" for i, e in enumerate(errands)]


def _document(key: str, rows: list[Row], work: Work) -> Row:
    document: Row = {key: rows, "more": work.more}
    return {**document, "cannot": work.cannot} if work.cannot else document
