"""A model's reply to the steps of a plan: lenient about what stands around the JSON, strict about what is in it.

Every fault is one sentence in the words of the prompt, so that the model can mend it.
"""

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches

from planners.prompt import one_line
from planners.writing.offered import MOST_AFTER, MOST_STEPS, Offered
from wire.messages.plan import Action, Param
from wire.model import Id, Vec2

_ID = re.compile(r"[a-z0-9][a-z0-9-]{0,15}")
_KEYS = frozenset({"id", "do", "object", "item", "room", "looking_for", "point_m", "params", "robot", "after"})
_MOST_FAULTS = 8


class Faulty(Exception):
    """A reply that cannot be used; `faults` says why, each in one sentence."""

    def __init__(self, faults: Sequence[str]) -> None:
        super().__init__(faults[0])
        self.faults = tuple(dict.fromkeys(faults))[:_MOST_FAULTS]


class Cannot(Exception):
    """The model says that the task cannot be done, and why; the text is a sentence for people."""


@dataclass(frozen=True)
class Written:
    """One step as a model wrote it, with the hub's ids."""

    id: str
    do: Action
    object: Id | None = None
    item: Id | None = None
    room: Id | None = None
    point_m: Vec2 | None = None
    looking_for: tuple[str, ...] = ()
    params: Mapping[str, Param] | None = None
    robot: Id | None = None
    after: tuple[str, ...] = ()


def object_with(text: str, key: str, listed: bool = True) -> dict[str, object]:
    """The first JSON object in a reply that has `key`, whatever stands around it; checked to be a list where `listed`.

    Raises Faulty, and Cannot where the model says that it cannot be done.
    """
    decoder = json.JSONDecoder()
    at = text.find("{")
    while at >= 0:
        try:
            value, _ = decoder.raw_decode(text, at)
        except (ValueError, RecursionError):
            value = None
        if isinstance(value, dict) and (key in value or "cannot" in value):
            return _whole(value, key) if listed else value
        at = text.find("{", at + 1)
    raise Faulty([f'there is no whole JSON object with "{key}" in it'])


def _whole(value: dict[str, object], key: str) -> dict[str, object]:
    why = value.get("cannot")
    if isinstance(why, str) and why.strip():
        raise Cannot(f"the model says: {one_line(why, 200)}")
    listed = value.get(key)
    if not isinstance(listed, list):
        raise Faulty([f'"{key}" must be a list'])
    if len(listed) > MOST_STEPS:
        raise Faulty([f'"{key}" has {len(listed)} entries; at most {MOST_STEPS} are allowed'])
    if any(not isinstance(entry, dict) for entry in listed):
        raise Faulty([f'every entry of "{key}" must be an object'])
    if not listed and is_more(value):
        raise Faulty([f'"more" is true, but "{key}" is empty: list what finds out what is missing'])
    return value


def is_more(document: Mapping[str, object]) -> bool:
    """Whether the plan only finds out what is missing."""
    return document.get("more") is True


def entries(document: Mapping[str, object], key: str) -> list[dict[str, object]]:
    """Those of a list that `object_with` has checked."""
    listed = document[key]
    return [entry for entry in listed if isinstance(entry, dict)] if isinstance(listed, list) else []


def name_of(value: object, where: str, faults: list[str]) -> str:
    """An id that the model has given: a short word or a number."""
    word = str(value).strip().lower() if isinstance(value, str | int) and not isinstance(value, bool) else ""
    if not _ID.fullmatch(word):
        faults.append(f'{where}: an id must be a short word such as "s1", not {_shown(value)}')
        return "?"
    return word


def names_of(value: object, where: str, faults: list[str]) -> tuple[str, ...]:
    """A list of such ids; a single one and none at all are lists, too."""
    listed = value if isinstance(value, list) else [] if value is None else [value]
    if len(listed) > MOST_AFTER:
        faults.append(f"{where}: at most {MOST_AFTER} ids may be listed")
    return tuple(dict.fromkeys(name_of(entry, where, faults) for entry in listed[:MOST_AFTER]))


def read_steps(
    raw: Sequence[Mapping[str, object]], offered: Offered, extra: frozenset[str] = frozenset(), within: str = ""
) -> list[Written]:
    """The steps of a list. `extra`: further keys that the caller reads; `within`: of which sub-task they are.

    Raises Faulty with all that is wrong.
    """
    faults: list[str] = []
    steps = [
        _Reader(entry, offered, f"{within}step {i}", faults, extra).step(f"s{i}") for i, entry in enumerate(raw, 1)
    ]
    known = [step.id for step in steps]
    faults += [
        f"{within}two steps have the id {id}: give each its own" for id in sorted(set(known)) if known.count(id) > 1
    ]
    for step in steps:
        faults += [f"{within}step {step.id} waits for {id}, which is no step" for id in step.after if id not in known]
    if faults:
        raise Faulty(faults)
    return steps


class _Reader:
    """Reads one step; faults are added to a list."""

    def __init__(
        self, raw: Mapping[str, object], offered: Offered, where: str, faults: list[str], extra: frozenset[str]
    ) -> None:
        self._raw, self._offered, self._faults, self._extra = raw, offered, faults, extra
        self._where = where

    def step(self, otherwise: str) -> Written:
        raw, offered = self._raw, self._offered
        id = name_of(raw.get("id", otherwise), self._where, self._faults)
        self._where = f"{self._where.rpartition('step ')[0]}step {id}"
        foreign = [key for key in raw if key not in _KEYS | self._extra]
        if foreign:
            self._fault(f"{one_line(foreign[0], 40)} is no part of a step; {', '.join(sorted(_KEYS))} are")
        do = self._chosen("do", list(offered.skills), "skill") or ""
        if not do and "do" not in raw:
            self._fault('"do" is missing: it names a skill')
        self._suits(do)
        robot = self._chosen("robot", offered.robots, "robot")
        if robot is not None and (why := offered.cannot(robot, do)):
            self._fault(why)
        return Written(
            id=id,
            do=do,
            object=self._thing("object"),
            item=self._thing("item"),
            room=self._chosen("room", offered.rooms, "room"),
            point_m=self._point(),
            looking_for=self._types(),
            params=self._params(do),
            robot=robot,
            after=names_of(raw.get("after"), self._where, self._faults),
        )

    def _fault(self, text: str) -> None:
        self._faults.append(f"{self._where}: {text}")

    def _suits(self, do: Action) -> None:
        """A field that the skill does not take is a sign of another skill being meant."""
        skill = self._offered.skills.get(do)
        if skill is None:
            return
        for key in ("object", "item", "room", "looking_for", "point_m"):
            if self._raw.get(key) not in (None, "", []) and key not in skill.takes and key != "item":
                self._fault(f"{do} takes {', '.join(skill.takes) or 'nothing'}, not {key}")

    def _chosen(self, key: str, among: Sequence[str], kind: str) -> str | None:
        value = self._raw.get(key)
        if value is None or value == "":
            return None
        if isinstance(value, str) and value in among:
            return value
        self._fault(f"there is no {kind} {_shown(value)}; {_instead(value, among)}")
        return None

    def _thing(self, key: str) -> Id | None:
        name = self._chosen(key, list(self._offered.things), "thing")
        return self._offered.things[name].id if name is not None else None

    def _types(self) -> tuple[str, ...]:
        value = self._raw.get("looking_for")
        listed = value if isinstance(value, list) else [] if value in (None, "") else [value]
        alike = {type.lower(): type for type in self._offered.types}
        found = []
        for entry in listed:
            type = alike.get(entry.lower().replace(" ", "")) if isinstance(entry, str) else None
            if type is None:
                self._fault(
                    f"{_shown(entry)} is not among the types to look for; {_instead(entry, self._offered.types)}"
                )
            else:
                found.append(type)
        return tuple(dict.fromkeys(found))

    def _point(self) -> Vec2 | None:
        value = self._raw.get("point_m")
        if value is None:
            return None
        match value:
            case [int() | float() as x, int() | float() as y] if not isinstance(x, bool) and not isinstance(y, bool):
                return (float(x), float(y))
        self._fault(f"point_m must be [east, north] in metres, not {_shown(value)}")
        return None

    def _params(self, do: Action) -> Mapping[str, Param] | None:
        value = self._raw.get("params")
        if value is None or value == {}:
            return None
        skill = self._offered.skills.get(do)
        own = skill.own if skill is not None else {}
        if not isinstance(value, dict) or any(not isinstance(v, bool | int | float | str) for v in value.values()):
            self._fault("params must be an object of numbers, texts, true and false")
            return None
        foreign = [name for name in value if name not in own]
        if foreign:
            self._fault(f"{one_line(foreign[0], 40)} is no parameter of {do}; {', '.join(own) or 'it has none'}")
            return None
        return dict(value)


def _shown(value: object) -> str:
    return f'"{one_line(str(value), 40)}"'


def _instead(value: object, among: Sequence[str]) -> str:
    near = get_close_matches(str(value), among, 4, 0.5) or list(among)[:4]
    return f"there are {', '.join(near)}" if near else "there are none"
