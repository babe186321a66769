"""Wishes to errands: what one robot does in one go, what it waits for, and the searches for what is not known."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from tests.ollama_double.planning.prompt_text import Known, Thing
from tests.ollama_double.planning.speech import Noun, Verb, Wish, Wishes
from wire.catalogue import catalogue

_STATE: dict[Verb, tuple[str, bool]] = {
    "toggle_on": ("on", True), "toggle_off": ("on", False), "open": ("open", True), "close": ("open", False),
    "clean": ("dirty", False), "slice": ("sliced", True),
}  # fmt: skip
_READY: dict[tuple[Verb, str], tuple[Verb, str, bool]] = {
    ("open", "microwave"): ("toggle_off", "on", False),
    ("toggle_on", "microwave"): ("close", "open", False),
    ("toggle_on", "laptop"): ("open", "open", True),
}
"""What has to be done first, unless a flag says that it is so already."""
SAYS: dict[Verb, str] = {"toggle_on": "switch on", "toggle_off": "switch off"}
BLADES = ("knife", "butterknife")
_MOST_TYPES = 8
GIVEN_UP = 3
"""So many failures with a thing are enough: another one is looked for."""


def type_of(word: str) -> str:
    """The type that a lower-case word stands for, as the prompt spells types."""
    return _SPELLED.get(word, word)


_SPELLED = {type.lower(): type for type in catalogue()}


@dataclass
class Step:
    do: str
    object: str = ""
    item: str = ""
    room: str = ""
    looking_for: tuple[str, ...] = ()
    waits: list[int] = field(default_factory=list)
    """Errands to be finished before this step."""


@dataclass
class Errand:
    what: str
    steps: list[Step]
    robot: str = ""

    @property
    def waits(self) -> list[int]:
        return sorted({i for step in self.steps for i in step.waits})

    @property
    def place(self) -> tuple[str, str]:
        """Room and first thing."""
        return self.steps[0].room, self.steps[0].object


@dataclass
class Work:
    """Everything that is to be done now. `more`: a further plan is needed. `cannot`: why nothing is done."""

    errands: list[Errand] = field(default_factory=list)
    more: bool = False
    cannot: str = ""


class Thinker:
    """Makes the errands of one instruction."""

    def __init__(self, known: Known, wishes: Wishes) -> None:
        self._known, self._wishes = known, wishes
        self._work = Work()
        self._missing: dict[str, bool] = {}
        """Words of types that have to be searched for, and whether all of them must be found."""
        self._chosen: list[Thing] = []
        """What the wish before was about."""
        self._targets: list[Thing] | None = None
        """Where the wish before moves something: what is to be closed then, or switched on."""
        self._rooms: set[str] = set()
        """To be looked into."""
        self._vain: list[str] = []
        self._opened: dict[str, int] = {}
        self._users: dict[str, list[int]] = {}
        self._of_group: dict[int, list[int]] = {}

    def work(self) -> Work:
        for wish in self._wishes.wanted:
            before = [i for group, own in self._of_group.items() if group < wish.group for i in own]
            first = len(self._work.errands)
            self._grant(wish)
            own = range(first, len(self._work.errands))
            for i in own:
                self._work.errands[i].steps[0].waits += before
            self._of_group.setdefault(wish.group, []).extend(own)
        self._put_down()
        self._tidy()
        self._search()
        if not self._wishes.wanted and not self._wishes.banned:
            self._work.cannot = "I do not understand the task"
        if not self._work.errands and self._vain:
            self._work.cannot = self._vain[0]
        return self._work

    def _banned(self, verb: Verb, name: str) -> bool:
        thing = self._known.things.get(name)
        return thing is not None and any(
            ban.verb in (verb, "touch") and ban.what.means(thing) for ban in self._wishes.banned
        )

    def _meant(self, noun: Noun) -> list[Thing]:
        """Those first with which nothing has gone wrong; the hopeless are left out."""
        if noun.it:
            return self._chosen
        failed = self._known.failed
        meant = [t for t in self._known.things.values() if noun.means(t) and failed[t.name] < GIVEN_UP]
        return sorted(meant, key=lambda thing: failed[thing.name])

    def _add(self, what: str, *steps: Step) -> int:
        self._work.errands.append(Errand(what, list(steps)))
        return len(self._work.errands) - 1

    def _grant(self, wish: Wish) -> None:
        if wish.what.room and not wish.what.words and not wish.what.name:
            self._add(f"go through {wish.what.room}", Step("explore", room=wish.what.room))
        elif wish.verb == "move" and wish.to is not None:
            self._move(wish.what, wish.to)
        elif wish.verb in _STATE:
            self._change(wish)
        elif wish.verb in ("find", "visit"):
            self._look(wish)

    def _change(self, wish: Wish) -> None:
        flag, wanted = _STATE[wish.verb]
        told_of = self._targets if wish.what.it and self._targets is not None else self._meant(wish.what)
        meant = [thing for thing in told_of if not self._banned(wish.verb, thing.name)]
        off = [thing for thing in meant if (flag in thing.flags) != wanted]
        told = [thing for thing in off if not wanted] or ([] if wish.what.every else [t for t in meant if t not in off])
        chosen = off if wish.what.every else (off or told)[: wish.what.count]
        if wish.what.every or len(chosen) < wish.what.count:
            self._want(wish.what)
        self._chosen = chosen
        for thing in chosen:
            if wish.verb == "close" and thing.name in self._opened:
                continue  # what was opened on the way is closed in the end, anyway
            if wish.verb == "slice":
                self._slice(thing)
            else:
                step = Step(wish.verb, thing.name, waits=self._reach(thing) + self._made_ready(wish.verb, thing))
                self._use(thing, self._add(f"{SAYS.get(wish.verb, wish.verb)} {thing.name}", step))

    def _made_ready(self, verb: Verb, thing: Thing) -> list[int]:
        """Some things must be otherwise before: a microwave is not opened while it runs."""
        needs = _READY.get((verb, thing.word))
        if needs is None or (needs[1] in thing.flags) == needs[2]:
            return []
        return [self._add(f"{SAYS.get(needs[0], needs[0])} {thing.name}", Step(needs[0], thing.name))]

    def _slice(self, food: Thing) -> None:
        blade = next((t for t in self._known.things.values() if t.word in BLADES), None)
        if blade is None:
            self._missing.setdefault(BLADES[0], False)
            return
        take = [] if self._holder(blade.name) else [Step("pickup", blade.name, waits=self._reach(blade))]
        cut = Step("slice", food.name, item=blade.name, waits=self._reach(food))
        down = [Step("put", table, item=blade.name) for table in self._surface(food.room, blade.name)]
        self._add(f"slice {food.name} with {blade.name}", *take, cut, *down)

    def _look(self, wish: Wish) -> None:
        meant = self._meant(wish.what)
        chosen = meant if wish.what.every else meant[: wish.what.count]
        if len(chosen) < wish.what.count or wish.what.every:
            self._want(wish.what)
        self._chosen = chosen
        for thing in chosen:
            self._add(f"look at {thing.name}", Step("inspect", thing.name, waits=self._reach(thing)))

    def _move(self, what: Noun, to: Noun) -> None:
        places = self._places(to)
        if not places:
            self._want(to)
            self._want_table(to)
        names = {place for place in places}
        things = [thing for thing in self._meant(what) if thing.name not in names]
        there = [
            t
            for t in things
            if (t.holder is not None and t.holder.name in names) or (not to.words and t.room == to.room and to.room)
        ]
        rest = [t for t in things if t not in there and not self._banned("move", t.name)]
        count = len(rest) if what.every else what.count - len(there)
        if what.every or len(rest) < count:
            self._want(what)
        self._chosen = [*there, *rest][: None if what.every else what.count]
        self._targets = [self._known.things[place] for place in places[:1]]
        for thing in rest[: max(count, 0)]:
            target = next((p for p in places if p != thing.name and not self._banned("move", p)), None)
            if target is not None:
                self._carry(thing, target)

    def _carry(self, thing: Thing, target: str) -> None:
        if self._known.shut(target) and self._banned("open", target):
            self._vain.append(f"{target} would have to be opened, which is forbidden")
            return
        take = [] if self._holder(thing.name) else [Step("pickup", thing.name, waits=self._reach(thing))]
        put = Step("put", target, item=thing.name, waits=self._open(target) + self._reach(self._known.things[target]))
        errand = self._add(f"put {thing.name} in {target}", *take, put)
        self._use(thing, errand)
        self._users.setdefault(target, []).append(errand)

    def _places(self, to: Noun) -> list[str]:
        """Where something can be put: things that are meant, or what holds things in a room that is."""
        if to.words or to.name:
            return [thing.name for thing in self._meant(to)]
        return list(self._surface(to.room, "", strictly=True))

    def _want_table(self, to: Noun) -> None:
        """A room in which nothing is known that things can be laid on is looked into."""
        if to.words or to.name:
            return
        if to.room in self._known.searched:
            self._vain.append(f"there is nothing in {to.room} to put it on")
        else:
            self._rooms.add(to.room)

    def _surface(self, room: str, but: str, strictly: bool = False) -> Iterator[str]:
        """Something to lay things on, best in the room."""
        tables = [
            thing
            for thing in self._known.things.values()
            if thing.name != but and (row := catalogue().get(type_of(thing.word))) is not None and row.receptacle_mode == "on"
            and row.kind != "pickup"
        ]  # fmt: skip
        there = [thing for thing in tables if thing.room == room]
        yield from (thing.name for thing in (there or ([] if strictly else tables))[:1])

    def _holder(self, name: str) -> str:
        return next((robot.name for robot in self._known.robots.values() if robot.holds == name), "")

    def _reach(self, thing: Thing) -> list[int]:
        """The openings that have to come before."""
        return [i for holder in thing.holders() for i in self._open(holder.name)]

    def _open(self, name: str) -> list[int]:
        if not self._known.shut(name):
            return []
        if name not in self._opened:
            ready = self._made_ready("open", self._known.things[name])
            self._opened[name] = self._add(f"open {name}", Step("open", name, waits=ready))
        return [self._opened[name]]

    def _use(self, thing: Thing, errand: int) -> None:
        for holder in thing.holders():
            self._users.setdefault(holder.name, []).append(errand)

    def _tidy(self) -> None:
        """Close what was opened on the way."""
        wanted = {t.name for w in self._wishes.wanted if w.verb == "open" for t in self._meant(w.what)}
        for name in self._opened:
            users = self._users.get(name, [])
            if name not in wanted and users:
                self._add(f"close {name}", Step("close", name, waits=[self._opened[name], *users]))

    def _put_down(self) -> None:
        """Hands that are full of what nobody wants to be carried."""
        used = {step.item for errand in self._work.errands for step in errand.steps}
        for robot in self._known.robots.values():
            if robot.holds and robot.holds not in used:
                for table in self._surface(robot.room, robot.holds):
                    self._add(f"put {robot.holds} in {table}", Step("put", table, item=robot.holds))

    def _want(self, noun: Noun) -> None:
        """Look for things of these types in rooms that nobody has gone through."""
        if noun.words:
            self._missing |= {
                word: noun.every or noun.inside is not None or self._missing.get(word, False) for word in noun.words
            }
            if not noun.every and not [r for r in self._known.rooms if r not in self._known.searched]:
                self._vain.append(f"there is no {' or '.join(sorted(type_of(w) for w in noun.words))} in any room")

    def _search(self) -> None:
        left = [room for room in self._known.rooms if room not in self._known.searched]
        if not (self._missing or self._rooms) or not left:
            return
        if not self._missing:
            left = [room for room in left if room in self._rooms]
        types = tuple(sorted(type_of(word) for word in self._missing))[:_MOST_TYPES]
        for room in left:
            if any(self._missing.values()) or room in self._rooms:
                self._add(f"go through {room}", Step("explore", room=room))
            else:
                self._add(f"search {room} for {' '.join(types)}", Step("explore", room=room, looking_for=types))
        self._work.more = True
