"""Looking for what is unknown: rooms first, then inside of closed things, then the rooms once more, then giving up."""

from dataclasses import dataclass

from planners.tasks.belief import Belief
from planners.tasks.priors import inside_prior, normalised
from planners.tasks.work import Impossible, Job, Step, on
from wire.catalogue import type_row
from wire.messages.world import AreaState, ObjectState
from wire.model import Vec2
from wire.outline import mean_m
from wire.site import Site

EVERY_INSIDE = 0.05
"""To find every thing of a type, closed receptacles are opened where it is at least this probable."""


@dataclass(frozen=True)
class Wanted:
    """Something looked for. `every`: all there are, so every room is gone through, whatever is found on the way."""

    types: tuple[str, ...]
    goal: int
    rooms: frozenset[str] | None = None
    every: bool = False
    name: str = ""
    reason: str = ""
    """Why those that are known are of no use."""


class Search:
    """Turns everything that is looked for into jobs."""

    def __init__(self, site: Site, belief: Belief) -> None:
        self._belief = belief
        self._centres: dict[str, Vec2] = {room.id: mean_m(room.polygon_m) for room in site.room}

    def jobs(self, wanted: list[Wanted]) -> tuple[list[Job], list[str]]:
        """Search jobs, and why some things are not looked for any more."""
        rooms: dict[str, list[tuple[Wanted, float]]] = {}
        peeks: dict[str, Job] = {}
        hopeless: list[str] = []
        for want in wanted:
            places = self._rooms(want, again=False)
            if not places:
                inside = self._closed(want)
                peeks.update({holder.id: self._peek(holder, want) for holder in inside})
                if inside or want.every:
                    continue
                places = self._rooms(want, again=True)
                if not places:
                    hopeless.append(self._in_vain(want))
                for area in places:
                    self._belief.notes.second_search.setdefault(area.id, area.searches)
            for area in places:
                chance = max(normalised(t, places, self._belief)[area.id] for t in want.types)
                rooms.setdefault(area.id, []).append((want, chance))
        explores = [self._explore(room, found) for room, found in sorted(rooms.items())]
        return explores + list(peeks.values()), hopeless

    def open_for(self, want: Wanted) -> bool:
        """Whether there is any place left to look."""
        return bool(self._rooms(want, again=False) or self._closed(want))

    def _rooms(self, want: Wanted, again: bool) -> list[AreaState]:
        """Rooms that are still to be gone through, the first or the second time."""
        notes, bans, failures = self._belief.notes, self._belief.bans, self._belief.failures
        return [
            area
            for area in self._belief.world.areas
            if area.id in self._centres
            and (want.rooms is None or area.id in want.rooms)
            and area.id not in bans.rooms
            and not failures.spent("explore", area.id)
            and (not notes.searched_again(area) if again else not area.searched)
        ]

    def _closed(self, want: Wanted) -> list[ObjectState]:
        """Closed receptacles that may hide it and that nobody has looked into."""
        belief = self._belief
        least = EVERY_INSIDE if want.every else 1e-9
        return [
            obj
            for obj in sorted(belief.world.objects, key=lambda o: o.id)
            if type_row(obj.type).must_open
            and not obj.looked_into
            and (obj.id in belief.notes.peeked or not belief.is_open(obj))
            and (want.rooms is None or obj.room in want.rooms)
            and max(inside_prior(t, obj) for t in want.types) >= least
            and not belief.bans.forbids("open", obj)
            and not belief.failures.spent("open", obj.id)
            and not belief.failures.spent("inspect", obj.id)
            and belief.held_by(obj) is None
        ]

    def _peek(self, holder: ObjectState, want: Wanted) -> Job:
        """One that was opened for a look which did not come about is still to be looked into."""
        self._belief.notes.peeked.add(holder.id)
        self._belief.notes.opened.add(holder.id)
        steps = [on("inspect", holder)] if self._belief.is_open(holder) else [on("open", holder), on("inspect", holder)]
        chance = max(inside_prior(t, holder) for t in want.types)
        return Job(steps, want.goal, about=frozenset({holder.id}), weight=chance)

    def _explore(self, room: str, found: list[tuple[Wanted, float]]) -> Job:
        """Where all of something is wanted, or another one than is known there, no sighting ends the search of a room."""
        types = tuple(dict.fromkeys(t for want, _ in found for t in want.types))
        known = any(obj.type in types for obj in self._belief.world.objects if obj.room == room)
        if known or any(want.every for want, _ in found):
            types = ()
        step = Step("explore", self._centres[room], room=room, looking_for=types)
        return Job([step], found[0][0].goal, weight=sum(chance for _, chance in found))

    def visit(self, room: str, goal: int) -> Job:
        """Go through one room because that is what was asked."""
        centre_m = self.centre_m(room)
        if room in self._belief.bans.rooms:
            raise Impossible(f"{room} may not be entered")
        if self._belief.failures.spent("explore", room):
            raise Impossible(self._belief.failures.last(room))
        return Job([Step("explore", centre_m, room=room)], goal)

    def centre_m(self, room: str) -> Vec2:
        """The middle of a room. Raises Impossible where there is no such room."""
        if room not in self._centres:
            raise Impossible(f"the site has no room {room}")
        return self._centres[room]

    def _in_vain(self, want: Wanted) -> str:
        if want.reason:
            return want.reason
        where = f" in {', '.join(sorted(want.rooms))}" if want.rooms is not None else " in any room"
        if self._belief.bans.rooms:
            where += " that may be entered"
        return f"no {want.name} was found{where}"
