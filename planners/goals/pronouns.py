"""What "it" may stand for. Where that is two things a model would choose one, and the operator is asked instead."""

from collections.abc import Iterator, Sequence

from planners.goals.wishes import PLACED, Entry
from planners.goals.words import Instruction, Told
from planners.scripted.resolve import FLAG, one_of
from planners.scripted.syntax import Unclear
from wire.catalogue import type_row
from wire.names import called

PRONOUNS = ("IT", "THEM")


def check_pronouns(entries: Sequence[Entry], instruction: Instruction) -> Iterator[str]:
    """Objections to goals that take "it" for what it cannot be. Raises Unclear where it can be two things."""
    for entry in entries:
        spoken = [told for told in entry.told if told.word.kind in PRONOUNS]
        if not spoken or _named(entry):
            continue
        choice = _choice(spoken[0], entry, instruction)
        if len(choice) > 1 and spoken[0].word.kind == "IT":
            names = one_of([called(name) for name in choice])
            raise Unclear(f"does 'it' in '{entry.wish.of}' stand for the {names}?", entry.wish.of, question=True)
        if choice and entry.wish.a not in choice and not entry.everything:
            yield f"'{spoken[0].text}' in '{entry.wish.of}' stands for {' or '.join(choice)}, not for {entry.wish.a}"


def _named(entry: Entry) -> bool:
    """The quotation itself names what the goal is about."""
    return any(told.word.kind in ("NOUN", "ID") and entry.wish.a in told.word.meaning.types for told in entry.told)


def _choice(pronoun: Told, entry: Entry, instruction: Instruction) -> list[str]:
    """Types named before the pronoun of which the goal could be; a word for several types counts as the goal's own."""
    flag = FLAG.get("in" if entry.wish.p in PLACED else entry.wish.p)
    found: list[str] = []
    for told in instruction.told:
        if told.word.kind not in ("NOUN", "ID") or min(told.at) > min(pronoun.at):
            continue
        types = told.word.meaning.types
        chosen = entry.wish.a if entry.wish.a in types else types[0]
        if (flag is None or type_row(chosen).can(flag[0])) and chosen != entry.wish.b:
            found.append(chosen)
    return list(dict.fromkeys(found))
