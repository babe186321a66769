"""The emulated planner for goal calls: a small reader of English that knows nothing but the prompt it is sent.

It finds the offered names and the instruction in the prompt, reads the sentence by its own word lists, and answers in
the shape that the prompt asks for. It is no model, and how well it reads says nothing about any.
"""

import json
import re
from typing import Any

from tests.ollama_double.brain import Brain, ChatRequest
from tests.ollama_double.deeds import Clause, Understanding, clauses
from tests.ollama_double.dials import Dials
from tests.ollama_double.english import Ear

_INSTRUCTION = re.compile(r'^instruction: "(?P<words>[^"]*)"$', re.M)
_OTHER = {"in": "found", "at": "found", "on": "off", "off": "on", "open": "closed", "closed": "open", "clean": "found"}


def knows(request: ChatRequest) -> bool:
    """A prompt that asks for goals and offers types."""
    return "Turn an operator's instruction" in request.system and _INSTRUCTION.search(request.user) is not None


def make(dials: Dials) -> Brain:
    return GoalReader(dials)


class GoalReader:
    """See tests.ollama_double.brain.Brain."""

    def __init__(self, dials: Dials) -> None:
        self._dials = dials

    def reply(self, request: ChatRequest) -> str:
        match = _INSTRUCTION.search(request.user)
        assert match is not None
        ear = Ear(_listed(request.user, "types"), _listed(request.user, "rooms"), _things(request.user))
        return json.dumps(self._spoilt(answer(ear, match["words"]), request))

    def _spoilt(self, reply: dict[str, Any], request: ChatRequest) -> dict[str, Any]:
        """The slips of attention that the dials ask for, each in one place."""
        dials, prompt, seed = self._dials, request.prompt, request.seed
        goals = reply["goals"]
        rng = dials.rng("where", prompt, seed)
        if goals and dials.slips("missing_goal", prompt, seed):
            goals.pop(rng.randrange(len(goals)))
        if goals and dials.slips("invented_id", prompt, seed):
            goals[rng.randrange(len(goals))]["a"] = rng.choice(("widget7", *_listed(request.user, "types")))
        if goals and dials.slips("wrong_skill", prompt, seed):
            wrong = goals[rng.randrange(len(goals))]
            wrong["p"] = _OTHER.get(wrong["p"], "clean")
        if dials.slips("missing_dependency", prompt, seed):
            for goal in goals:
                goal.pop("step", None)
        if dials.slips("dropped_negation", prompt, seed):
            reply["keep"] = []
        return reply


def _listed(user: str, name: str) -> list[str]:
    """The names on one line of the prompt, without what is quoted."""
    line = re.search(rf"^{name}: (.*)$", user, re.M)
    return re.sub(r'"[^"]*"', "", line[1]).split() if line else []


def _things(user: str) -> list[str]:
    line = re.search(r"^seen: (.*)$", user, re.M)
    return re.findall(r"\b[a-z]+\d+\b", re.sub(r'"[^"]*"', "", line[1])) if line else []


def answer(ear: Ear, words: str) -> dict[str, Any]:
    """The whole reply without slips."""
    understanding = Understanding()
    found = clauses(ear.hear(words))
    for clause in found:
        understanding.read(clause)
    reply: dict[str, Any] = {"goals": [], "keep": []}
    talk: list[str] = []
    for clause, step in zip(found, _steps(found), strict=True):
        (start, end), whole = clause.core(), clause.span()
        talk.append(words[whole[0] : start if clause.wishes else end])
        for wish in clause.wishes:
            kept = bool(clause.all("deny")) and _denied(clause, wish)
            row = {"of": words[start:end], **wish}
            if step and not kept:
                row["step"] = step
            reply["keep" if kept else "goals"].append(row)
    reply["talk"] = [text for text in talk if text.strip()][:8]
    if understanding.unknown:
        reply["unknown"] = understanding.unknown[:8]
    if understanding.ask:
        reply["ask"] = understanding.ask
    return reply


def _denied(clause: Clause, wish: dict[str, Any]) -> bool:
    """ "Is not open" is a state to bring about; every other denial is a restraint."""
    return not (clause.all("state") and wish["p"] in ("on", "off", "open", "closed"))


def _steps(found: list[Clause]) -> list[int]:
    """The step of each clause; 0 for all where nothing asks for an order."""
    joints = [clause.joint for clause in found]
    if not set(joints) & {"then", "before", "after"}:
        return [0] * len(found)
    steps, now = [], 1
    for index, joint in enumerate(joints):
        if joint in ("then", "before") and index:
            now += 1
        steps.append(now)
    for index, joint in enumerate(joints):
        if joint == "after" and index:
            steps = [step + 1 if i < index else 1 for i, step in enumerate(steps)]
    if joints[0] in ("before", "after"):
        steps = [2 if (i == 0) == (joints[0] == "before") else 1 for i in range(len(found))]
    return steps
