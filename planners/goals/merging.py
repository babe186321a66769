"""Several replies to one instruction as one: what one of them got wrong another may have right."""

from collections.abc import Sequence

from planners.goals.offered import Offered
from planners.goals.reply import Reply, Wish
from planners.goals.wishes import Entry, entry_of, wish_faults
from planners.goals.words import Instruction

MOST_TALK = 8


def merged(replies: Sequence[Reply], instruction: Instruction, offered: Offered) -> Reply | None:
    """Every wish that nobody objects to, once, in the order of the operator's words; those with a step first choice.

    None where these are fewer than one of the replies had: then something that was asked for may be among the others.
    """
    pairs = [pair for reply in reversed(replies) for pair in reply.wishes()]
    chosen: list[Entry] = []
    for wish, kept in sorted(pairs, key=lambda pair: pair[0].step is None):
        entry = entry_of(wish, kept, instruction, offered)
        known = any(other.kept == kept and _same(other.wish, wish) for other in chosen)
        if not known and not wish_faults(entry, instruction, offered):
            chosen.append(entry)
    chosen.sort(key=lambda entry: min(entry.span))
    goals = tuple(entry.wish for entry in chosen if not entry.kept)
    if len(goals) < max(len(reply.goals) for reply in replies):
        return None
    talk = dict.fromkeys(words for reply in replies for words in reply.talk if instruction.find(words))
    return Reply(
        goals=goals,
        keep=tuple(entry.wish for entry in chosen if entry.kept),
        talk=tuple(talk)[:MOST_TALK],
    )


def _same(one: Wish, other: Wish) -> bool:
    """The same, however many and when."""
    return (one.p, one.a, one.b, one.a_in) == (other.p, other.a, other.b, other.a_in)
