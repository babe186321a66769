"""A slip that code can put right without asking again: the predicate, where the quoted words allow one only."""

from planners.goals.reply import Reply, Wish
from planners.goals.wishes import PLACED, turned
from planners.goals.words import ALSO, Instruction, denies

NEVER_MEANT = frozenset({"touched"})
"""Only ever forbidden."""


def mended(reply: Reply, instruction: Instruction) -> Reply:
    """The same reply with those goals put right whose words ask for something else than they say."""
    goals = tuple(_mended(wish, instruction) for wish in reply.goals)
    return reply.model_copy(update={"goals": goals})


def _mended(wish: Wish, instruction: Instruction) -> Wish:
    """With a b something is put there; without one it is made so. A denial is left to the critics."""
    told = instruction.within(instruction.find(wish.of))
    if any(denies(word) or word.word.kind == "LEAVE" for word in told):
        return wish
    asked = {p for word in told if word.word.kind not in ALSO and word.word.kind != "TURN" for p in word.asks}
    asked |= turned(told)
    asked -= NEVER_MEANT
    possible = asked & set(PLACED) if wish.b is not None else asked - set(PLACED)
    if wish.p in asked or not possible:
        return wish
    if possible <= set(PLACED):
        return wish.model_copy(update={"p": "in"})
    return wish.model_copy(update={"p": next(iter(possible))}) if len(possible) == 1 else wish
