"""What is settled before a model is asked: choices that only the operator can make, and wishes that no goal says."""

import re
from collections.abc import Sequence

from planners.goals.offered import INSTRUCTION_LIMIT
from planners.goals.words import Instruction, Told
from planners.prompt import one_line
from planners.scripted.resolve import one_of
from planners.scripted.syntax import Unclear
from wire.messages.world import WorldState
from wire.names import called

_PROGRAMS = re.compile(r"<[|/]?\w+[|/]?>|\[/?[A-Z]{3,}\]|```|[][{}=\\]|\b(system|assistant|user)\s*:", re.I)
"""What opens a turn of a chat, or a value of a program: nobody says such a thing to a robot."""


def check_choices(instruction: Instruction, said: str, world: WorldState) -> None:
    """Raises Unclear: a model would guess where the grammar asks."""
    if len(said) > INSTRUCTION_LIMIT:
        raise Unclear(
            f"an instruction has at most {INSTRUCTION_LIMIT} characters, this one has {len(said)}: say it in parts"
        )
    marks = _PROGRAMS.search(said)
    if marks is not None:
        raise Unclear(f"say it in plain words: '{one_line(marks[0], 40)}' is a mark of programs", final=True)
    present = {obj.type for obj in world.objects}
    for index, told in enumerate(instruction.told):
        meaning, kind = told.word.meaning, told.word.kind
        if kind == "CHECK_IF":
            raise Unclear("questions are not answered: say 'make sure that ...', or ask './justw why'", told.word.text)
        if meaning.plural or _counted(instruction.told[:index]):
            continue
        if kind == "NOUN" and len(meaning.types) > 1 and len(present & set(meaning.types)) != 1:
            choice = one_of([called(name) for name in meaning.types])
            raise Unclear(f"which kind is meant by '{told.word.text}': {choice}?", told.word.text, question=True)
        if kind == "ROOM" and len(meaning.ids) > 1:
            raise Unclear(
                f"which one is meant by '{told.word.text}': {one_of(meaning.ids)}?", told.word.text, question=True
            )


def _counted(before: Sequence[Told]) -> bool:
    """ "Every lamp", "no lamp", "both lamps" leave no choice."""
    for told in reversed(before):
        if told.word.kind in ("ALL", "BOTH", "NO", "NUM"):
            return True
        if told.word.kind not in ("ADJ", "DIRTY", "CLEAN", "OPEN", "ISOPEN", "ISCLOSED", "OF", "THE"):
            return False
    return False
