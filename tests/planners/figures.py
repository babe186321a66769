"""Figures of the planner `goals`: `python -m tests.planners.figures [--json]`.

What a goal call costs in a home with thirty known things, what a replan costs, and how the emulated planner's errors
tell on whole tasks. The emulated planner is no model: its error-free row shows what the code around a model lets
through, the others how much of a model's errors that code makes good.
"""

import argparse
import json
import sys
from dataclasses import asdict, astuple, dataclass

from planners.asking import ModelFailed
from planners.goals.planner import GoalsPlanner
from planners.modelled import modelled
from planners.scripted.syntax import Unclear
from tests.ollama_double.dials import Dials
from tests.planners.emulated_model import COUNTER, EmulatedModel, tokens
from tests.planners.executor import run
from tests.planners.home import home, home_world
from tests.planners.instructions import Row, rows, written
from tests.planners.toy import site
from wire.goals import holds
from wire.messages.plan import ModelCall, PlanRequest

KINDS = (
    "invented_id",
    "missing_goal",
    "missing_dependency",
    "wrong_skill",
    "dropped_negation",
    "broken_json",
    "prose",
)
MIXED = 0.085
"""The rate of each kind at which three replies in ten come out otherwise than without errors: not every reply has a
restraint to drop, or an order."""


@dataclass
class Tally:
    """Over rows of the corpus. `exact`: the wanted goals, or a refusal where one is wanted; `wrong`: other goals."""

    tasks: int = 0
    exact: int = 0
    wrong: int = 0
    done: int = 0
    """Exact, and carried out in the toy house until the goals held in truth."""
    calls: int = 0
    spoilt: int = 0
    """Replies that would have been others without the errors."""

    def __add__(self, other: "Tally") -> "Tally":
        return Tally(*(mine + theirs for mine, theirs in zip(astuple(self), astuple(other), strict=True)))


def outcome(row: Row, model: EmulatedModel) -> str:
    """What the planner makes of an instruction, in the notation of the corpus."""
    request = PlanRequest(task="t", epoch=1, instruction=row.say, world=home_world(), now_s=1.0)
    calls: list[ModelCall] = []
    try:
        return written(GoalsPlanner(site(), model).read(request, calls))
    except Unclear as unclear:
        return "?" if unclear.question else "!"
    except ModelFailed:
        return "!"


def carried_out(row: Row, model: EmulatedModel) -> bool:
    """Whether the task ends with the goals true, or refused where that is wanted; plans and replans included."""
    house = home()
    planner = modelled(GoalsPlanner, lambda _: model, sleep=lambda _: None)(site())
    reply, goals, _ = run(house, planner, row.say)
    if reply.plan is None:
        return row.refused
    return not row.refused and all(holds(goal, house.truth()) for goal in goals)


def tally(dials: Dials, by: str, execute: bool = True) -> Tally:
    """Over the rows that are read by the grammar, or by the model."""
    total = Tally()
    for row in rows():
        if row.by != by:
            continue
        model = EmulatedModel(dials)
        got = outcome(row, model)
        exact = got == row.want or (row.refused and got in ("!", "?"))
        done = exact and execute and carried_out(row, EmulatedModel(dials))
        total += Tally(1, exact, not exact and got not in ("!", "?"), done, len(model.said), spoilt(model))
    return total


def spoilt(model: EmulatedModel) -> int:
    clean = EmulatedModel()
    return sum(clean.ask(question).text != text for question, text in model.said)


def prompt_tokens() -> list[int]:
    """Of the first question for every row that needs the model, in the home with thirty known things."""
    counts = []
    for row in rows():
        model = EmulatedModel()
        outcome(row, model)
        counts += [tokens(question) for question, _ in model.said[:1]]
    return sorted(counts)


def replan_calls() -> int:
    """Calls of the model for all plans of one task after the first."""
    model = EmulatedModel()
    planner = modelled(GoalsPlanner, lambda _: model, sleep=lambda _: None)(site())
    _, _, replies = run(home(), planner, "tuck the teddy bear in the box, then kill the telly")
    assert len(replies) > 1
    return sum(len(reply.calls) for reply in replies[1:])


def figures(seeds: int, execute: bool) -> dict[str, object]:
    counts = prompt_tokens()
    grammar = tally(Dials(), "grammar", execute)
    runs = {"none": [tally(Dials(), "model", execute)]}
    for name, rate in (("in 3 replies of 10", MIXED), ("each kind in 3 of 10", 0.3)):
        runs[name] = [tally(Dials(seed=n, **dict.fromkeys(KINDS, rate)), "model", execute) for n in range(seeds)]
    return {
        "known_things": len(home_world().objects),
        "counted_by": COUNTER.name,
        "prompt_tokens": {"median": counts[len(counts) // 2], "largest": counts[-1], "questions": len(counts)},
        "calls_of_replans": replan_calls(),
        "read_by_the_grammar": asdict(grammar),
        "errors": {
            name: {
                "model_rows": asdict(sum(found, Tally())),
                "all_rows": asdict(sum((grammar + f for f in found), Tally())),
            }
            for name, found in runs.items()
        },
    }


def main() -> None:
    parser = argparse.ArgumentParser(prog="figures", description="Figures of the planner `goals`, emulated.")
    parser.add_argument("--json", action="store_true", help="one object on one line")
    parser.add_argument("--seeds", type=int, default=3, help="of the errors")
    parser.add_argument("--no-execution", action="store_true", help="read the instructions, carry nothing out")
    arguments = parser.parse_args()
    found = figures(arguments.seeds, not arguments.no_execution)
    sys.stdout.write(json.dumps(found, indent=None if arguments.json else 1) + "\n")


if __name__ == "__main__":
    main()
