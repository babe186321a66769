"""A vision model's reply, believed as far as it can be true: names and roles that were offered, places in the picture.

What a model writes is data. Names, roles, parts and states are choices among those that were offered; sentences are
kept as quotations of bounded length, and nothing here or later acts on them.
"""

import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from math import atan2, dist, radians
from typing import Any

from pydantic import BaseModel, ConfigDict, ValidationError

from devices.vision.gridmask import Grid
from devices.vision.prompt import PARTS, PLACE, ROLES, STATES, WALKER, Duty
from devices.vision.quoting import quoted

MOST_CHARACTERS = 32_000
MOST_SENTENCES, MOST_TEXTS, SENTENCE_CHARACTERS = 3, 8, 160
SAME_CELLS = 0.25
"""Two entries of one name nearer than this are one thing."""


class ReplyError(ValueError):
    """Nothing in it can be used; one sentence."""


@dataclass(frozen=True)
class Entry:
    """One thing that the model reports."""

    name: str
    x_cells: float
    y_cells: float
    yaw_rad: float | None = None
    """Counter-clockwise in the picture."""
    role: str | None = None
    part: str | None = None
    state: str | None = None


@dataclass(frozen=True)
class Report:
    """What is left of a reply."""

    entries: tuple[Entry, ...]
    sentences: tuple[str, ...] = ()
    """What the model says is going on, each quoted."""
    texts: tuple[str, ...] = ()
    """What the model reads in the picture, each quoted."""
    doubts: tuple[str, ...] = ()
    """Why entries were left out, a sentence for each kind."""

    @property
    def heading_rad(self) -> float | None:
        """Of the walking robot, in the picture, from its tail (or body) to its head (or body)."""
        parts = {e.part: (e.x_cells, e.y_cells) for e in self.entries if e.name == WALKER}
        ahead, behind = parts.get("head") or parts.get("body"), parts.get("tail") or parts.get("body")
        if ahead is None or behind is None or ahead == behind:
            return None
        return atan2(ahead[1] - behind[1], ahead[0] - behind[0])


class _Item(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)
    name: str
    x: float
    y: float
    yaw_deg: float | None = None
    role: str | None = None
    part: str | None = None
    state: str | None = None


def read(text: str, duty: Duty, grid: Grid, cell_m: float | None = None) -> Report:
    """What of a reply can be believed. `cell_m` is how long a cell is on the ground, where cubes are looked at.

    Raises ReplyError when it is no JSON object with a list of objects.
    """
    whole = _object(text)
    items = whole.get("objects")
    if not isinstance(items, list):
        raise ReplyError("the model's reply has no list `objects`")
    doubts: Counter[str] = Counter()
    entries: list[Entry] = []
    for item in items[: duty.most_objects]:
        entry = _entry(item, duty, grid, doubts)
        if entry is not None:
            entries.append(entry)
    if len(items) > duty.most_objects:
        doubts[f"beyond the {duty.most_objects} that were asked for"] += len(items) - duty.most_objects
    entries = _once(entries, duty, doubts)
    if duty.edge_m is not None and cell_m is not None:
        entries = _apart(entries, duty.edge_m / cell_m, doubts)
    return Report(
        tuple(entries),
        _strings(whole.get("events"), MOST_SENTENCES) if duty.events else (),
        _strings(whole.get("texts"), MOST_TEXTS),
        tuple(f"{count} left out: {why}" for why, count in doubts.items()),
    )


def _object(text: str) -> dict[str, Any]:
    """The first JSON object in the text; small models like to talk before and after it."""
    start = text.find("{")
    if start < 0 or len(text) > MOST_CHARACTERS:
        raise ReplyError(f"the model's reply is no JSON object: {quoted(text, 80)}")
    try:
        value, _ = json.JSONDecoder().raw_decode(text, start)
    except (json.JSONDecodeError, RecursionError):
        raise ReplyError(f"the model's reply is broken JSON: {quoted(text[start:], 80)}") from None
    assert isinstance(value, dict), "what begins with a brace is an object"
    return value


def _entry(item: Any, duty: Duty, grid: Grid, doubts: Counter[str]) -> Entry | None:
    try:
        read_item = _Item.model_validate(item)
    except ValidationError:
        doubts["not of the agreed form"] += 1
        return None
    if read_item.name not in duty.names:
        doubts["under a name that was not offered"] += 1
        return None
    if not grid.contains(read_item.x, read_item.y):
        doubts["outside the picture"] += 1
        return None
    asked = {field: getattr(read_item, field) for field in duty.fields}
    choices = {"role": ROLES, "part": PARTS if read_item.name == WALKER else (), "state": STATES}
    wrong = [f for f in choices if asked.get(f) is not None and asked[f] not in choices[f]]
    if wrong:
        doubts[f"with a {wrong[0]} that was not offered"] += 1
        return None
    yaw_deg = asked.get("yaw_deg")
    yaw_rad = None if yaw_deg is None else radians(yaw_deg)
    return Entry(
        read_item.name, read_item.x, read_item.y, yaw_rad, asked.get("role"), asked.get("part"), asked.get("state")
    )


def _once(entries: Sequence[Entry], duty: Duty, doubts: Counter[str]) -> list[Entry]:
    """Without doubles, and without what there cannot be so many of."""
    kept: list[Entry] = []
    counts: Counter[tuple[str, str | None]] = Counter()
    for entry in entries:
        twins = [k for k in kept if (k.name, k.part) == (entry.name, entry.part)]
        if any(_apart_cells(entry, twin) < SAME_CELLS for twin in twins):
            doubts["named twice in one place"] += 1
        elif counts[entry.name, entry.part] >= _most(entry, duty):
            doubts["more of one name than there can be"] += 1
        else:
            counts[entry.name, entry.part] += 1
            kept.append(entry)
    return kept


def _most(entry: Entry, duty: Duty) -> int:
    """Parts of the robot and places are there once."""
    return 1 if entry.part is not None or entry.name == PLACE else duty.most_of_one


def _apart(entries: Sequence[Entry], edge_cells: float, doubts: Counter[str]) -> list[Entry]:
    """Two cubes nearer than an edge are one that was misread, and one picture does not say which: neither is believed."""
    cubes = [e for e in entries if e.name.startswith("cube_")]
    wrong = {id(e) for a, b in combinations(cubes, 2) if _apart_cells(a, b) < edge_cells for e in (a, b)}
    if wrong:
        doubts["nearer to another cube than an edge"] += len(wrong)
    return [e for e in entries if id(e) not in wrong]


def _apart_cells(a: Entry, b: Entry) -> float:
    return dist((a.x_cells, a.y_cells), (b.x_cells, b.y_cells))


def _strings(value: Any, most: int) -> tuple[str, ...]:
    """Sentences as quotations; what is no sentence is left out."""
    if not isinstance(value, list):
        return ()
    return tuple(quoted(s, SENTENCE_CHARACTERS) for s in value[:most] if isinstance(s, str) and s.strip())
