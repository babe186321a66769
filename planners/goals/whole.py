"""Is a reply the whole of what was said? Every noun, verb, number and denial of the instruction must be in it."""

from collections.abc import Iterator, Sequence

from planners.goals.reply import Reply
from planners.goals.wishes import Entry, is_act, quantifiers_before
from planners.goals.words import ASKED_BY, DENYING, NAMING, OPPOSITE, Instruction, Told, denies, excepts, negates
from planners.prompt import one_line
from planners.scripted.resolve import FLAG
from wire.catalogue import type_row

STATED = frozenset({"on", "off", "open", "closed", "clean", "in", "at"})
STATED_BY = frozenset(kind for kind in ASKED_BY if kind.startswith("IS"))
ENDING_STATES = STATED_BY | {"ON", "OFF"}
ORDERING = frozenset({"THEN", "BEFORE", "AFTER"})


def reply_faults(reply: Reply, entries: Sequence[Entry], instruction: Instruction) -> list[str]:
    """What is missing in it, or stands in the wrong list; one sentence each."""
    talk = frozenset(i for words in reply.talk for i in instruction.find(words))
    faults = [*_talk(reply, entries, instruction)]
    for index, told in enumerate(instruction.told):
        if told.at <= talk and not (told.word.kind in NAMING and _relevant(told, entries)):
            continue
        covering = [entry for entry in entries if told.at <= entry.span]
        every = told.word.meaning.plural or any(
            before.word.kind in ("ALL", "BOTH", "NO") for before in quantifiers_before(instruction.told[:index])
        )
        faults += _uncovered(told, covering, every)
    faults += _order([entry for entry in entries if not entry.kept], instruction, talk)
    return list(dict.fromkeys(faults))


def _relevant(told: Told, entries: Sequence[Entry]) -> bool:
    """A noun in chatter that some goal is about is covered there or not at all."""
    return any(told.at <= entry.span for entry in entries)


def _talk(reply: Reply, entries: Sequence[Entry], instruction: Instruction) -> Iterator[str]:
    """Chatter neither asks for anything nor names what no goal is about."""
    types = {name for entry in entries for name in entry.types}
    rooms = {name for entry in entries for name in entry.rooms}
    for words in reply.talk:
        span = instruction.find(words)
        if not span:
            yield f"talk '{one_line(words, 60)}' is not in the instruction"
        inside = instruction.within(span)
        if _commands(inside):
            yield f"talk '{one_line(words, 60)}' may ask for something: put what no name fits into unknown"
        if any(told.word.kind in ("BEFORE", "AFTER") for told in inside):
            yield f"talk '{one_line(words, 60)}' tells when: make a goal with a step of it, or put its words into unknown"
        if any(negates(told) for told in inside) and any(told.word.kind in ("IT", "THEM") for told in inside):
            yield f"talk '{one_line(words, 60)}' denies something: say it in keep, or put its words into unknown"
        for told in inside:
            if any(told.at <= entry.span for entry in entries) or told.at <= instruction.speaker_at(span):
                continue
            meaning = told.word.meaning
            if is_act(told) or told.word.kind == "EVERYTHING":
                yield f"'{told.text}' in talk asks for something: make a goal of it"
            elif told.word.kind in ("NOUN", "ID") and not types & set(meaning.types):
                yield f"'{told.text}' in talk names a thing: make a goal of it, or put the words into unknown"
            elif told.word.kind == "ROOM" and not rooms & set(meaning.ids):
                yield f"'{told.text}' in talk names a room: make a goal of it, or put the words into unknown"


def _commands(inside: Sequence[Told]) -> bool:
    """A strange word at the beginning and something that it may be done to: "feed the goldfish", "smash mugs"."""
    if len(inside) < 2 or not inside[0].nameless:
        return False
    named = any(told.word.kind in (*NAMING, "EVERYTHING") for told in inside[1:])
    return named or inside[-1].word.kind in ("IT", "THEM") or (len(inside) > 2 and inside[1].word.kind == "THE")


def _uncovered(told: Told, covering: Sequence[Entry], every: bool) -> Iterator[str]:
    kind, meaning = told.word.kind, told.word.meaning
    if kind in ("NOUN", "ID"):
        yield from _noun(told, covering, every)
    elif kind == "ROOM":
        missing = set(meaning.ids) - {room for entry in covering for room in entry.rooms}
        if missing and (meaning.plural or missing == set(meaning.ids)):
            yield f"'{told.text}' is in no goal: it must be a, b, a_in, b_in or in except"
    elif kind == "EVERYTHING" and not any(entry.everything for entry in covering):
        yield f"'{told.text}' is in no goal that is about Everything"
    elif kind == "NUM" and meaning.base != "1" and not any(str(e.wish.n) == meaning.base for e in covering):
        yield f"'{told.text}' is in no goal: say it with n"
    elif is_act(told):
        if not any(_done(told, entry, covering) for entry in covering):
            yield f"'{told.text}' is in no goal that does it"
    elif kind in STATED_BY and not any(_stated(told, entry) for entry in covering):
        yield f"'{told.text}' is in no goal that makes it so"
    if (told.nameless or (kind in ASKED_BY and not is_act(told) and kind != "VIEW")) and not covering:
        yield f"'{told.text}' is in no goal: quote it in of, or in talk or unknown"
    if denies(told) or kind == "LEAVE":
        yield from _denial(told, covering)


def _noun(told: Told, covering: Sequence[Entry], every: bool) -> Iterator[str]:
    """One type of those that it may mean; all of them where it is said of all."""
    used = {name for entry in covering for name in entry.types}
    wanted = set(told.word.meaning.types)
    if not used & wanted:
        yield f"'{told.text}' is in no goal: it must be a, b, a_in or in except"
    elif every and len(wanted) > 1:
        flags = [FLAG.get(entry.wish.p) for entry in covering if not entry.kept]
        able = {t for t in wanted if all(flag is None or type_row(t).can(flag[0]) for flag in flags)}
        for name in sorted(able - used):
            yield f"'{told.text}' are {name} too: one goal for each type"


def _done(told: Told, entry: Entry, covering: Sequence[Entry]) -> bool:
    """Whether a goal does what a verb says; what is opened only to be closed again needs no goal."""
    if entry.wish.p in ASKED_BY[told.word.kind]:
        return True
    closed = any(other.wish.p == "closed" for other in covering)
    return told.word.kind == "OPEN" and closed and any(other.wish.p in ("in", "at") for other in covering)


def _stated(told: Told, entry: Entry) -> bool:
    """A state that a goal makes true or, denied, its opposite; "the closed box" only tells which one is meant."""
    asked = ASKED_BY[told.word.kind]
    after = [other for other in entry.told if min(other.at) == max(told.at) + 1]
    return bool(asked & {entry.wish.p, OPPOSITE.get(entry.wish.p, "")}) or any(o.word.kind == "NOUN" for o in after)


def _denial(told: Told, covering: Sequence[Entry]) -> Iterator[str]:
    if any(_heeds(told, entry) for entry in covering):
        return
    where = "except" if excepts(told) else "keep"
    yield f"'{told.text}' is not heeded: say in {where} what it takes out"


def _heeds(told: Told, entry: Entry) -> bool:
    """A restraint, an exception, or a state that is the opposite of the one denied."""
    if entry.kept and entry.wish.p == "touched" and negates(told) and entry.told[-1].word.kind in ENDING_STATES:
        return False  # "no TV stays on" asks for more than to leave them alone
    if entry.kept or (entry.wish.out and told.word.kind not in DENYING):
        return True
    if told.word.kind == "LEAVE":
        return entry.wish.p in STATED
    later = {p for other in entry.told if min(other.at) > min(told.at) and not is_act(other) for p in other.asks}
    if negates(told):
        return entry.wish.p in {OPPOSITE[p] for p in later if p in OPPOSITE}
    return bool(later) and entry.wish.p in later and not excepts(told)


def _order(goals: Sequence[Entry], instruction: Instruction, talk: frozenset[int]) -> Iterator[str]:
    """Steps as "then", "before" and "after" have them."""
    for told in instruction.told:
        if told.word.kind not in ORDERING or told.at <= talk:
            continue
        if len(goals) < 2:
            if told.word.kind != "THEN":
                yield f"'{told.text}' ties two goals together: there are not two, put what no name fits into unknown"
            continue
        steps = {entry.wish.step for entry in goals}
        if len(steps) < 2:
            yield f"'{told.text}' asks for an order: give the goals steps 1, 2, ..."
            continue
        left = [entry.wish.step or 0 for entry in goals if max(entry.span) < min(told.at)]
        right = [entry.wish.step or 0 for entry in goals if min(entry.span) > max(told.at)]
        if left and right and 0 in (*left, *right):
            yield f"'{told.text}' asks for an order: every goal before and after it needs a step"
            continue
        first, second = (right, left) if told.word.kind == "AFTER" else (left, right)
        if first and second and max(first) >= min(second):
            yield f"'{told.text}' asks for another order: what comes first has the lower step"
