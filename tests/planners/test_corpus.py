"""Sentences and the exact goals, or the exact words refused, that they must come out as."""

from pathlib import Path

import pytest

from planners.scripted.goals import read_goals
from planners.scripted.syntax import Unclear
from wire.messages.goal import Goal, Selector
from wire.messages.world import AreaState, RobotState, WorldState

ROOMS = (
    ("kitchen", "Kitchen", "Kitchen"),
    ("bedroom-1", "Bedroom 1", "Bedroom"),
    ("bedroom-2", "Bedroom 2", "Bedroom"),
    ("living-room", "Living room", "LivingRoom"),
    ("bathroom", "Bathroom", "Bathroom"),
)
WORLD = WorldState(
    seq=0,
    stamp_s=0.0,
    areas=tuple(
        AreaState(id=i, name=name, kind=kind, seen_fraction=0.0, camera_fraction=0.0) for i, name, kind in ROOMS
    ),
    robots=(
        RobotState(
            id="dog-1", kind="quadruped", position_enu_m=(0.0, 0.0, 0.0), yaw_deg=0.0, status="idle", stamp_s=0.0
        ),
    ),
)


def note(selector: Selector) -> str:
    """Short notation: type, * for all, xN for a count, [field=value], \\exception."""
    count = {1: "", None: "*"}.get(selector.count, f"x{selector.count}")
    fields = "".join(
        f"[{name}={getattr(selector, name)}]" for name in ("id", "room", "inside") if getattr(selector, name)
    )
    return (selector.type or "") + count + fields + "".join("\\" + note(out) for out in selector.exclude)


def notation(goal: Goal) -> str:
    arguments = note(goal.subject) + (f",{note(goal.object)}" if goal.object else "")
    order = f"<{','.join(map(str, goal.after))}" if goal.after else ""
    return f"{'FORBID ' if goal.forbidden else ''}{goal.predicate}({arguments}){order}"


def reading(sentence: str, world: WorldState = WORLD) -> str:
    """Goals in notation; `! part` for a refusal, `? part` for a question."""
    try:
        return " ; ".join(notation(goal) for goal in read_goals(sentence, world))
    except Unclear as unclear:
        return f"{'?' if unclear.question else '!'} {unclear.part}"


def rows() -> list[tuple[str, str]]:
    lines = Path(__file__).with_name("corpus.txt").read_text().splitlines()
    return [
        (a.strip(), b.strip())
        for a, b in (line.split("=>", 1) for line in lines if line.strip() and not line.startswith("#"))
    ]


@pytest.mark.parametrize(("sentence", "wanted"), rows())
def test_reading(sentence: str, wanted: str) -> None:
    assert reading(sentence) == wanted


def test_the_corpus_is_large() -> None:
    assert len(rows()) >= 120
    assert sum(wanted[0] in "!?" for _, wanted in rows()) >= 40
