"""A planning prompt taken apart again: its sections, the rooms with what is in them, the robots and what they can."""

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

HEADINGS = (
    *("skills", "robots can", "world", "closed unless (open)", "types to look for", "your last plan", "since then"),
    *("went wrong", "task", "sub-tasks", "resumes", "objections", "who can", "you are", "your resume"),
    *("proposed for you", "kind", "entries", "may be the same", "you replied", "that cannot be used"),
)
_HEADING = re.compile(rf"({'|'.join(re.escape(h) for h in HEADINGS)})(?::| (?=[a-z0-9-]+$))(.*)")
_NAME = re.compile(r"[a-z][a-z0-9-]*")
_QUOTED = re.compile(r'"([^"]*)"')
_FAILED = re.compile(r"could not [a-z_]+ ([a-z]+[0-9]+)")


def sections(text: str) -> dict[str, list[str]]:
    """Heading -> its lines; what stands on the heading's own line comes first."""
    found: dict[str, list[str]] = {}
    lines = found.setdefault("", [])
    for line in text.splitlines():
        heading = _HEADING.fullmatch(line)
        if heading is not None:
            lines = found.setdefault(heading[1], [])
            if heading[2].strip():
                lines.append(heading[2].strip())
        else:
            lines.append(line)
    return found


@dataclass
class Thing:
    name: str
    room: str
    holder: "Thing | None" = None
    flags: tuple[str, ...] = ()

    @property
    def word(self) -> str:
        """Its type, as one lower-case word."""
        return self.name.rstrip("0123456789")

    def holders(self) -> Iterator["Thing"]:
        """From the inside out."""
        holder = self.holder
        while holder is not None:
            yield holder
            holder = holder.holder


@dataclass
class Robot:
    name: str
    room: str = ""
    holds: str = ""
    skills: frozenset[str] = frozenset()


@dataclass
class Known:
    """All that the prompt tells."""

    rooms: list[str] = field(default_factory=list)
    called: dict[str, str] = field(default_factory=dict)
    """Room -> its name in words."""
    searched: set[str] = field(default_factory=set)
    things: dict[str, Thing] = field(default_factory=dict)
    doors: set[str] = field(default_factory=set)
    """Things that are closed unless they are said to be open."""
    robots: dict[str, Robot] = field(default_factory=dict)
    failed: Counter[str] = field(default_factory=Counter)
    """Thing -> how often a robot could not do something with it."""

    def shut(self, name: str) -> bool:
        return name in self.doors and "open" not in self.things[name].flags


def read_known(parts: dict[str, list[str]]) -> Known:
    """What the sections say of the place and the team."""
    known = Known()
    for line in parts.get("world", ()):
        head, _, rest = line.partition(": ")
        if head == "robots":
            _read_robots(rest, known)
        elif head:
            _read_room(head, rest, known)
    known.doors = {
        name for line in parts.get("closed unless (open)", ()) for name in line.split() if name in known.things
    }
    for line in (*parts.get("robots can", ()), *parts.get("resumes", ())):
        names, _, skills = line.partition(":")
        for name in re.sub(r"\(.*?\)|\".*?\"", "", names).split():
            robot = known.robots.setdefault(name, Robot(name))
            robot.skills = robot.skills | frozenset(re.findall(r"[a-z]+(?:_[a-z]+)*", skills))
    for line in parts.get("went wrong", ()):
        known.failed.update(_FAILED.findall(line))
    for robot in known.robots.values():
        if robot.holds and robot.holds not in known.things:
            known.things[robot.holds] = Thing(robot.holds, robot.room)
    return known


def _read_room(head: str, rest: str, known: Known) -> None:
    name = _NAME.match(head)
    if name is None:
        return
    room = name[0] if name[0] != "somewhere" else ""
    if room:
        known.rooms.append(room)
        quoted = _QUOTED.search(head)
        known.called[room] = (quoted[1] if quoted else room.replace("-", " ")).lower()
        if "(searched)" in head:
            known.searched.add(room)
    _read_things(rest, 0, room, None, known)


def _read_things(text: str, at: int, room: str, holder: Thing | None, known: Known) -> int:
    """Things from a place on, up to the bracket that ends their list."""
    while at < len(text):
        if text[at] == "]":
            return at + 1
        name = _NAME.match(text, at)
        if name is None:
            at += 1
            continue
        thing = known.things[name[0]] = Thing(name[0], room, holder)
        at = name.end()
        if text[at : at + 1] == "(":
            end = _end_of_flags(text, at)
            thing.flags = tuple(_QUOTED.sub("", text[at + 1 : end]).split())
            at = end + 1
        if text[at : at + 1] == "[":
            at = _read_things(text, at + 1, room, thing, known)
    return at


def _end_of_flags(text: str, at: int) -> int:
    """Where the bracket that opens here is closed; what stands in quotation marks does not count."""
    quoted = False
    for place in range(at, len(text)):
        quoted ^= text[place] == '"'
        if text[place] == ")" and not quoted:
            return place
    return len(text)


def _read_robots(text: str, known: Known) -> None:
    for match in re.finditer(r"([a-z0-9-]+)\(([^)]*)\)", text):
        robot = known.robots.setdefault(match[1], Robot(match[1]))
        for word in (part.strip() for part in match[2].split(",")):
            if word in known.rooms:
                robot.room = word
            elif word.startswith("holds "):
                robot.holds = word.removeprefix("holds ")
