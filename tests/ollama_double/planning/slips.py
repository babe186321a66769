"""The errors that know what a plan means: a thing that is not there, a wait left out, a skill that does not fit."""

import re
from dataclasses import dataclass
from random import Random

from tests.ollama_double.brain import ChatRequest
from tests.ollama_double.dials import Dials
from tests.ollama_double.planning.speech import Wish

_NUMBERED = re.compile(r"\b([a-z]+)(\d+)\b")
_OTHER = {
    "pickup": "open", "put": "pickup", "open": "toggle_on", "close": "toggle_off", "toggle_on": "open",
    "toggle_off": "toggle_on", "explore": "inspect", "inspect": "pickup", "clean": "pickup", "slice": "toggle_on",
}  # fmt: skip
_OTHER_WORDS = (("switch off", "switch on"), ("open", "close"), ("put", "open"), ("search", "clean"), ("close", "open"))
Row = dict[str, object]


@dataclass(frozen=True)
class Slips:
    """Those of one reply, at places chosen by the dials' seed."""

    dials: Dials
    request: ChatRequest

    def _chance(self, kind: str) -> Random:
        return self.dials.rng("place", kind, self.request.prompt, self.request.seed)

    def happens(self, kind: str) -> bool:
        return self.dials.slips(kind, self.request.prompt, self.request.seed)  # type: ignore[arg-type]

    def wishes(self, wanted: list[Wish]) -> None:
        """Forget a part of the task."""
        if wanted and self.happens("missing_goal"):
            wanted.remove(self._chance("missing_goal").choice(wanted))

    def steps(self, rows: list[Row]) -> None:
        """Spoil a list of steps in place."""
        named = [row for row in rows if "object" in row or "item" in row]
        if named and self.happens("invented_id"):
            row = self._chance("invented_id").choice(named)
            key = "object" if "object" in row else "item"
            row[key] = _invented(str(row[key]))
        waiting = [row for row in rows if row.get("after")]
        if waiting and self.happens("missing_dependency"):
            self._chance("missing_dependency").choice(waiting)["after"] = []
        doing = [row for row in rows if row.get("do") in _OTHER]
        if doing and self.happens("wrong_skill"):
            row = self._chance("wrong_skill").choice(doing)
            row["do"] = _OTHER[str(row["do"])]

    def subtasks(self, rows: list[Row]) -> None:
        """The same of sub-tasks, whose things and skills stand in words."""
        named = [row for row in rows if _NUMBERED.search(str(row["what"]))]
        if named and self.happens("invented_id"):
            row = self._chance("invented_id").choice(named)
            row["what"] = _invented(str(row["what"]))
        waiting = [row for row in rows if row.get("after")]
        if waiting and self.happens("missing_dependency"):
            self._chance("missing_dependency").choice(waiting)["after"] = []
        if rows and self.happens("wrong_skill"):
            row = self._chance("wrong_skill").choice(rows)
            words = str(row["what"])
            row["what"] = next((b + words.removeprefix(a) for a, b in _OTHER_WORDS if words.startswith(a)), words)

    def table(self, rows: list[Row], robots: list[str]) -> None:
        """A robot that is not there, or a wait left out, in a table of who does what."""
        if rows and self.happens("invented_id"):
            row = self._chance("invented_id").choice(rows)
            ghost = f"{robots[0].rstrip('0123456789') if robots else 'robot-'}{len(robots) + 40}"
            key = "robots" if "robots" in row else "robot"
            row[key] = [ghost] if key == "robots" else ghost
        waiting = [row for row in rows if row.get("after")]
        if waiting and self.happens("missing_dependency"):
            self._chance("missing_dependency").choice(waiting)["after"] = []


def _invented(text: str) -> str:
    """The first numbered name with a number that nothing has."""
    return _NUMBERED.sub(lambda match: f"{match[1]}{int(match[2]) + 40}", text, count=1)
