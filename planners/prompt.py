"""The world as lean text for language models, and text of strangers as harmless quotations.

One line a room, things nested in what holds them, only what is out of the ordinary said of each: `kitchen:
countertop1[apple1 mug1(dirty)] fridge1(open)`. The hub's ids stay outside: a prompt has short names, and `Names` knows
what is behind them. Nothing that a person, a camera or a device wrote gets in except through `quoted`.
"""

import unicodedata
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from importlib.resources import files

from planners.vocabulary import mentioned_types
from wire.catalogue import catalogue
from wire.messages.plan import SkillCard
from wire.messages.world import AreaState, ObjectState, RobotState, WorldState

NAME_LIMIT, SENTENCE_LIMIT = 32, 160
STALE_S = 600.0
DOUBTED = 0.6
"""Below this confidence the source of a belief is worth its tokens."""
LIKELY = 0.3
FLAGS = {"isOpen": "open", "isToggled": "on", "isDirty": "dirty", "isSliced": "sliced"}
"""Property -> what is said of a thing that has it; what has not is not said."""
LOW_BATTERY = 0.3
KINDS = frozenset({"quadruped", "drone"})
"""Robots that need no quotation marks."""
_MARKS = str.maketrans(
    {
        **dict.fromkeys('"“”„‟«»`´‘’', "'"),
        "<": "(",
        ">": ")",
        "{": "(",
        "}": ")",
        "[": "(",
        "]": ")",
        "|": "/",
        "\\": "/",
    }
)


def quoted(text: str, limit: int = SENTENCE_LIMIT) -> str:
    """Anybody's text as one field between quotation marks."""
    return f'"{one_line(text, limit)}"'


def one_line(text: str, limit: int) -> str:
    """Text without line breaks, without marks that could end a quotation or open a turn of a chat, cut short."""
    plain = unicodedata.normalize("NFKC", text)
    plain = "".join(" " if unicodedata.category(c)[0] in "CZ" else c for c in plain).translate(_MARKS)
    words = " ".join(plain.split())
    return words if len(words) <= limit else words[: limit - 1].rstrip() + "…"


def label(type_name: str) -> str:
    """A type as it stands in a prompt: as it is where everybody knows it, quoted where only a detector does."""
    return type_name if type_name in catalogue() else quoted(type_name, NAME_LIMIT)


@lru_cache(maxsize=32)
def system_prompt(purpose: str) -> str:
    """The text of `prompts/PURPOSE.md`: the same to the byte in every call, so that a server may keep its state."""
    return files("planners").joinpath("prompts", f"{purpose}.md").read_text(encoding="utf-8").strip()


class Names:
    """Short names of things, each kept while its thing is known: `apple1` for the hub's id, and back."""

    def __init__(self) -> None:
        self._short: dict[str, tuple[str, str]] = {}
        """Id -> type and name."""
        self._ids: dict[str, str] = {}
        self._given: Counter[str] = Counter()

    def learn(self, world: WorldState) -> None:
        """Names for what is new or has turned out to be something else; those of what is gone are not given again."""
        present = {obj.id: obj.type for obj in world.objects}
        for id, (type_name, name) in list(self._short.items()):
            if present.get(id) != type_name:
                del self._short[id], self._ids[name]
        for id, type_name in sorted(present.items()):
            if id not in self._short:
                word = type_name.lower() if type_name in catalogue() else "thing"
                self._given[word] += 1
                name = f"{word}{self._given[word]}"
                self._short[id], self._ids[name] = (type_name, name), id

    def short(self, id: str) -> str:
        """The name of a thing; robots and rooms, and what is not known, are called by their ids."""
        return self._short[id][1] if id in self._short else id

    def id(self, name: str) -> str | None:
        """The hub's id of a short name."""
        return self._ids.get(name)


def relevant(instruction: str, world: WorldState) -> frozenset[str]:
    """Ids of the things that an instruction may be about, and of what they are in; of everything where it names none."""
    types = mentioned_types(instruction, {obj.type for obj in world.objects})
    return holding({obj.id for obj in world.objects if obj.type in types} or {obj.id for obj in world.objects}, world)


def holding(things: Iterable[str], world: WorldState) -> frozenset[str]:
    """Ids of things with those of what they are in, to the outermost."""
    by_id = {obj.id: obj for obj in world.objects}
    chosen = set(things)
    for id in sorted(chosen):
        holder = by_id.get(by_id[id].receptacle or "")
        while holder is not None and holder.id not in chosen:
            chosen.add(holder.id)
            holder = by_id.get(holder.receptacle or "")
    return frozenset(chosen)


def world_text(world: WorldState, names: Names, now_s: float, only: Iterable[str] | None = None) -> str:
    """Rooms with what is known to be in them, then the robots. `only`: ids of the things to speak of; None is all."""
    wanted = frozenset(only) if only is not None else frozenset(obj.id for obj in world.objects)
    held = {robot.inventory for robot in world.robots if robot.inventory is not None}
    shown = [obj for obj in world.objects if obj.id in wanted and obj.id not in held]
    ids = {obj.id for obj in shown}
    children: Mapping[str | None, list[ObjectState]] = defaultdict(list)
    for obj in sorted(shown, key=lambda o: names.short(o.id)):
        children[obj.receptacle if obj.receptacle in ids else None].append(obj)
    lines = [
        _room_line(area, [o for o in children[None] if o.room == area.id], children, names, now_s)
        for area in world.areas
    ]
    rooms = {area.id for area in world.areas}
    lost = [_thing(obj, children, names, now_s) for obj in children[None] if obj.room not in rooms]
    if lost:
        lines.append(f"somewhere: {' '.join(lost)}")
    if world.robots:
        lines.append(f"robots: {' '.join(_robot(robot, names) for robot in world.robots)}")
    return "\n".join(lines)


def _room_line(
    area: AreaState,
    top: Sequence[ObjectState],
    children: Mapping[str | None, list[ObjectState]],
    names: Names,
    now_s: float,
) -> str:
    things = " ".join(_thing(obj, children, names, now_s) for obj in top) or "-"
    return f"{room_text(area)}{' (searched)' if area.searched else ''}: {things}"


def room_text(area: AreaState) -> str:
    """A room by its id; with its name where that is not the id spelled out."""
    usual = area.name.lower().replace(" ", "-") == area.id
    return area.id if usual else f"{area.id} {quoted(area.name, NAME_LIMIT)}"


def _thing(obj: ObjectState, children: Mapping[str | None, list[ObjectState]], names: Names, now_s: float) -> str:
    flags = list(_flags(obj, now_s))
    inside = " ".join(_thing(child, children, names, now_s) for child in children.get(obj.id, ()))
    said = f"({' '.join(flags)})" if flags else ""
    return f"{names.short(obj.id)}{said}[{inside}]" if inside else f"{names.short(obj.id)}{said}"


def _flags(obj: ObjectState, now_s: float) -> Iterable[str]:
    if obj.type not in catalogue():
        yield label(obj.type)
    for prop, flag in FLAGS.items():
        fact = obj.props.get(prop)
        if fact is not None and (fact.value or fact.contradicted_by):
            said = flag if fact.value else f"not-{flag}"
            yield f"{said}?{fact.source}" if fact.contradicted_by or fact.confidence < DOUBTED else said
    yield from (f"maybe-{label(other)}" for other, chance in sorted(obj.maybe.items()) if chance >= LIKELY)
    if obj.confidence < DOUBTED:
        yield f"?{obj.source}"
    if now_s - obj.stamp_s > STALE_S:
        yield age_text(now_s - obj.stamp_s)


def age_text(age_s: float) -> str:
    """ "~12m", "~3h": how long ago, about."""
    return f"~{age_s / 60:.0f}m" if age_s < 5400.0 else f"~{age_s / 3600:.0f}h"


def _robot(robot: RobotState, names: Names) -> str:
    said = [robot.kind if robot.kind in KINDS else quoted(robot.kind, NAME_LIMIT)]
    if robot.room is not None:
        said.append(robot.room)
    if robot.status != "idle":
        said.append(robot.status)
    if robot.inventory is not None:
        said.append(f"holds {names.short(robot.inventory)}")
    if robot.battery is not None and robot.battery < LOW_BATTERY:
        said.append(f"battery {robot.battery:.0%}")
    return f"{robot.id}({', '.join(said)})"


def skills_text(skills: Sequence[SkillCard]) -> str:
    """What robots have announced, one line a skill: the name is an action, the rest a stranger's description of it."""
    return "\n".join(f"{card.name}: {quoted(card.doc.split(chr(10))[0])}" for card in skills)


def failures_text(failures: Sequence[str], limit: int = 8) -> str:
    """What went wrong, the last ones last, as devices and the hub have put it."""
    return "\n".join(f"- {quoted(sentence)}" for sentence in failures[-limit:])
