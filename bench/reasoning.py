"""`./justw bench reasoning`: planners beside each other on the same episodes, and how they bear a model's errors.

The emulated planner answers, with errors at several rates; `--host` asks a real model server instead, which makes its
own. Whatever the emulated one answers says nothing of any model, and everything here repeats that. Ctrl-C ends it; what is
measured is kept in the JSON file, and the same command goes on from there.
"""

import argparse
import json
import re
import subprocess
import sys
import time
from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bench.reasoning_plot import draw
from bench.reasoning_table import summary, table_text
from planners.model_inspection import inspect
from planners.planner import PLANNERS
from wire.planner_table import PlannerChoice

HOMES = (6, 15, 8, 13, 5, 11, 2, 21)
"""Seeds of homes, each with an instruction of its own, from two errands in five rooms on."""
RATES = (0.0, 0.1, 0.2, 0.3, 0.5)
WITHOUT_MODEL = frozenset({"scripted"})
OUT = Path("out/reasoning")
Trial = dict[str, Any]


@dataclass(frozen=True)
class Order:
    """One trial that is wanted."""

    planner: str
    home: int
    rate: float

    @property
    def key(self) -> tuple[str, int, float]:
        return (self.planner, self.home, self.rate)


def orders(planners: Sequence[str], rates: Sequence[float], homes: Sequence[int]) -> list[Order]:
    """Home by home, so that what is there after a while compares all. Who asks no model makes none of its errors."""
    return [
        Order(planner, home, rate)
        for home in homes
        for planner in planners
        for rate in (rates[:1] if planner in WITHOUT_MODEL else rates)
    ]


class OtherSettings(ValueError):
    """The file is of another comparison."""


class Measurement:
    """The trials so far, written to a file after each."""

    def __init__(self, settings: dict[str, Any], file: Path) -> None:
        self.settings, self._file = settings, file
        self.trials: list[Trial] = _kept(settings, file)

    def lacks(self, order: Order) -> bool:
        return not any((t["planner"], t["home"], t["rate"]) == order.key for t in self.trials)

    def add(self, trial: Trial) -> None:
        self.trials.append(trial)
        self.write()

    def write(self) -> None:
        place = {planner: i for i, planner in enumerate(PLANNERS)}
        self.trials.sort(key=lambda t: (place.get(t["planner"], len(place)), t["rate"], t["home"]))
        document = {"settings": self.settings, "summary": summary(self.trials), "trials": self.trials}
        self._file.parent.mkdir(parents=True, exist_ok=True)
        draft = self._file.with_suffix(".part")
        draft.write_text(json.dumps(document, indent=1, sort_keys=True) + "\n")
        draft.replace(self._file)


def _kept(settings: dict[str, Any], file: Path) -> list[Trial]:
    """Trials of an earlier run. Raises OtherSettings: what took hours is not written over."""
    try:
        document = json.loads(file.read_text())
    except (OSError, ValueError):
        return []
    if not isinstance(document, dict):
        return []
    there = document.get("settings")
    if there != settings and document.get("trials"):
        said = ", ".join(f"{name} {value}" for name, value in dict(there or {}).items() if value != "")
        raise OtherSettings(f"{file} has trials with other settings ({said}): name another file with --json")
    return list(document.get("trials", ()))


def unanswered(trial: Trial) -> bool:
    """Whether every call went to a server that did not answer: nothing is measured then of any planner."""
    task = trial["task"]
    return bool(task["model_calls"]) and task["prompt_tokens"] + task["completion_tokens"] == 0


class Crew:
    """Carries out trials, each in a process of its own, so that none leaves anything to the next."""

    def __init__(self, given: argparse.Namespace) -> None:
        self._given = given
        self._children: set[subprocess.Popen[str]] = set()
        self._over = False

    def carry_out(self, order: Order) -> Trial:
        """Raises RuntimeError with its last words."""
        given = self._given
        command = [
            sys.executable, "-m", "bench.reasoning_trial", "--planner", order.planner, "--home", str(order.home),
            "--rate", str(order.rate), "--robots", str(given.robots), "--host", given.host, "--model", given.model,
        ]  # fmt: skip
        child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self._children.add(child)
        if self._over:
            child.terminate()
        said, complained = child.communicate()
        self._children.discard(child)
        if child.returncode != 0:
            raise RuntimeError((complained.strip().splitlines() or ["it said nothing"])[-1])
        trial: Trial = json.loads(said.strip().splitlines()[-1])
        if unanswered(trial):
            raise RuntimeError(trial["task"]["reason"])
        return trial

    def end(self) -> None:
        self._over = True
        for child in list(self._children):
            child.terminate()


def measure(wanted: Sequence[Order], kept: Measurement, given: argparse.Namespace) -> int:
    """Carry out what is lacking; returns how many trials broke. KeyboardInterrupt ends it, what is done stays."""
    left = [order for order in wanted if kept.lacks(order)]
    began_s, broken, crew = time.monotonic(), 0, Crew(given)
    with ThreadPoolExecutor(given.jobs) as pool:
        running: dict[Future[Trial], Order] = {pool.submit(crew.carry_out, order): order for order in left}
        try:
            for number, future in enumerate(as_completed(running), 1):
                order = running[future]
                try:
                    trial = future.result()
                    kept.add(trial)
                    said = _line(trial)
                except RuntimeError as error:
                    broken += 1
                    said = f"{order.planner} at {order.rate:.0%}, home {order.home}: broke: {error}"
                minutes = (time.monotonic() - began_s) / number * (len(left) - number) / 60.0
                print(f"[{number}/{len(left)}, {minutes:.0f} min left] {said}", file=sys.stderr, flush=True)
        except KeyboardInterrupt:
            pool.shutdown(wait=False, cancel_futures=True)
            crew.end()
            raise
    return broken


def _line(trial: Trial) -> str:
    task = trial["task"]
    end = "succeeded" if trial["success"] else f"{task['status']}, {trial['goals_true']} of {trial['goals']} goals true"
    tokens = task["prompt_tokens"] + task["completion_tokens"]
    return (
        f"{trial['planner']} at {trial['rate']:.0%}, home {trial['home']}: {end}, {task['model_calls']} calls, "
        f"{tokens} tokens, {trial['sim_s']:g} s simulated"
    )


def label_of(given: argparse.Namespace, trials: Sequence[Trial]) -> str:
    """Where the answers came from."""
    if given.host and not any(trial["task"]["stand_in"] for trial in trials):
        return f"{given.model}"
    return "emulated: the answers are those of a stand-in with errors on purpose, and say nothing of any model"


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="bench reasoning", description=__doc__)
    parser.add_argument("--planners", nargs="+", choices=list(PLANNERS), default=list(PLANNERS), metavar="NAME")
    parser.add_argument("--rates", nargs="+", type=float, default=list(RATES), help="of errors, from 0 to 1")
    parser.add_argument("--homes", nargs="+", type=int, default=list(HOMES), help="seeds")
    parser.add_argument("--robots", type=int, default=2)
    parser.add_argument("--jobs", type=int, default=1, help="trials at the same time; each takes a core")
    parser.add_argument("--host", default="", help="a model server to ask instead, such as http://127.0.0.1:11434")
    parser.add_argument("--model", default="qwen3:8b", help="its model")
    parser.add_argument("--json", type=Path, metavar="FILE", help=f"left out: in {OUT}/, one for each model")
    given = parser.parse_args()
    if any(not 0.0 <= rate < 1.0 for rate in given.rates):
        parser.error("a rate of errors lies between 0 and 1, such as 0.1")
    if given.jobs < 1 or given.robots < 1:
        parser.error(f"--{'jobs' if given.jobs < 1 else 'robots'}: give 1 or more")
    if given.host:
        given.rates = [0.0]
    given.json = given.json or OUT / file_name(given.model if given.host else "")
    return given


def file_name(model: str) -> str:
    """Of the results of a real model, or, without a name, of the emulated one."""
    return f"{re.sub(r'[^A-Za-z0-9.]+', '-', model)}.json" if model else "reasoning.json"


def server_fault(given: argparse.Namespace) -> str:
    """Why the server that is to be asked cannot answer with this model; empty where it can, or none is asked."""
    if not given.host or set(given.planners) <= WITHOUT_MODEL:
        return ""
    state = inspect(PlannerChoice(host=given.host, model=given.model))
    return "" if state.fault is None else f"{given.model}: {state.fault.text}"


def main() -> None:
    given = _arguments()
    settings = {"robots": given.robots, "host": given.host, "model": given.model if given.host else "emulated"}
    try:
        kept = Measurement(settings, given.json)
    except OtherSettings as error:
        sys.exit(f"error: {error}")
    if fault := server_fault(given):
        sys.exit(f"error: {fault}")
    wanted = orders(given.planners, given.rates, given.homes)
    broken = 0
    try:
        broken = measure(wanted, kept, given)
    except KeyboardInterrupt:
        broken = 1
        print("interrupted: this is what was measured; the same command goes on from here", file=sys.stderr)
    if not kept.trials:
        sys.exit(1)
    kept.write()
    label, rows, picture = label_of(given, kept.trials), summary(kept.trials), given.json.with_suffix(".png")
    print(table_text(rows, label))
    draw(rows, label, picture)
    print(f"wrote {given.json} and {picture}")
    sys.exit(1 if broken else 0)


if __name__ == "__main__":
    main()
