"""What EMOS calls a robot's resume: its body and abilities in a few words, written by the model once for each kind."""

from planners.parse import Faulty, object_with
from planners.prompt import one_line
from planners.writing.capabilities import kind_text, skill_lines
from planners.writing.dialogue import Dialogue
from planners.writing.offered import Offered
from wire.model import Id

PURPOSE = "emos_resume"
PARTS = ("mobility", "perception", "manipulation", "limits")
_PART_LIMIT, _MOST_TOKENS, _KEPT = 120, 300, 32
_SCHEMA = {
    "type": "object",
    "properties": {part: {"type": "string", "maxLength": _PART_LIMIT} for part in PARTS},
    "required": list(PARTS),
    "additionalProperties": False,
}


class Resumes:
    """Kept: robots with the same kind and skills have the same."""

    def __init__(self) -> None:
        self._written: dict[tuple[str, tuple[str, ...]], str] = {}

    def of(self, offered: Offered, dialogue: Dialogue) -> dict[Id, str]:
        """Of every robot that is there."""
        found = {}
        for robot in offered.request.world.robots:
            if robot.id not in offered.robots:
                continue
            key = (kind_text(robot), robot.skills)
            if key not in self._written:
                self._written[key] = self._ask(offered.only(robot.id), key[0], dialogue)
                while len(self._written) > _KEPT:
                    del self._written[next(iter(self._written))]
            found[robot.id] = self._written[key]
        return found

    def _ask(self, offered: Offered, kind: str, dialogue: Dialogue) -> str:
        user = f"kind: {kind}\nskills:\n{skill_lines(offered.skills.values())}"
        return dialogue.ask(PURPOSE, user, _SCHEMA, _read, _MOST_TOKENS)


def _read(text: str) -> str:
    document = object_with(text, "mobility", listed=False)
    missing = [part for part in PARTS if not isinstance(document.get(part), str)]
    if missing:
        raise Faulty([f'"{missing[0]}" is missing'])
    return "; ".join(f"{part}: {one_line(str(document[part]), _PART_LIMIT)}" for part in PARTS)
