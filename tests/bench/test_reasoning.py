"""Planners beside each other: what is counted, what is kept, and that it can be ended and gone on with."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import cv2
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench.emulated import dials_at
from bench.reasoning import Measurement, Order, OtherSettings, file_name, orders, unanswered
from bench.reasoning_plot import draw
from bench.reasoning_table import interval, summary, table_text
from planners.planner import PLANNERS


def trial(planner: str, home: int, rate: float, success: bool, tokens: int = 1000) -> dict[str, Any]:
    task = {
        "status": "done", "prompt_tokens": tokens, "completion_tokens": 0, "model_calls": 1, "replans": 0, "path_m": 5.0,
        "stand_in": True,
    }  # fmt: skip
    return {
        "planner": planner,
        "home": home,
        "rate": rate,
        "success": success,
        "goals_true": 1 + success,
        "goals": 2,
        "sim_s": 30.0,
        "task": task,
    }


TRIALS = [trial("single_shot", home, 0.1, home % 2 == 0, 1000 * home) for home in range(1, 5)]


def test_the_chance_of_an_error_in_a_reply_is_the_rate() -> None:
    for rate in (0.0, 0.1, 0.5):
        good = 1.0
        for chance in dials_at(rate).values():
            good *= 1.0 - chance
        assert 1.0 - good == pytest.approx(rate)


def test_rows_count_what_was_true_and_what_was_only_believed() -> None:
    (row,) = summary(TRIALS)
    assert (row["succeeded"], row["episodes"], row["wrongly_done"], row["tokens"]) == (2, 4, 2, 2500)
    assert row["goals_true"] == 0.75
    text = table_text([row], "emulated: ...")
    assert text.startswith("emulated")
    assert "2/4" in text


@given(number=st.integers(1, 200), share=st.floats(0.0, 1.0))
def test_an_interval_holds_the_share_and_stays_within_bounds(number: int, share: float) -> None:
    good = round(share * number)
    low, high = interval(good, number)
    assert 0.0 <= low <= good / number + 1e-12
    assert good / number - 1e-12 <= high <= 1.0


def test_whoever_asks_no_model_is_measured_once_a_home() -> None:
    wanted = orders(("scripted", "emos"), (0.0, 0.5), (1, 2))
    assert [order.key for order in wanted if order.planner == "scripted"] == [
        ("scripted", 1, 0.0),
        ("scripted", 2, 0.0),
    ]
    assert len(wanted) == 6


def test_what_is_measured_is_kept_for_the_same_settings_alone(tmp_path: Path) -> None:
    file = tmp_path / "out" / "reasoning.json"
    first = Measurement({"robots": 2}, file)
    first.add(TRIALS[0])
    again = Measurement({"robots": 2}, file)
    assert not again.lacks(Order("single_shot", 1, 0.1))
    assert again.lacks(Order("single_shot", 2, 0.1))
    with pytest.raises(OtherSettings, match=r"other settings \(robots 2\): name another file with --json"):
        Measurement({"robots": 3}, file)
    file.write_text("{broken")
    assert Measurement({"robots": 2}, file).trials == []


def test_every_model_has_a_file_of_its_own() -> None:
    assert [file_name(model) for model in ("", "qwen3:8b", "hf.co/a/b:Q4")] == [
        "reasoning.json",
        "qwen3-8b.json",
        "hf.co-a-b-Q4.json",
    ]


def test_a_server_that_does_not_answer_measures_nothing() -> None:
    silent = trial("goals", 1, 0.0, False, tokens=0)
    assert unanswered(silent)
    assert not unanswered(trial("goals", 1, 0.0, False))
    assert not unanswered({**silent, "task": {**silent["task"], "model_calls": 0}}), "scripted asks nobody"


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (("--jobs", "0"), "--jobs: give 1 or more"),
        (("--robots", "0"), "--robots: give 1 or more"),
        (("--host", "http://127.0.0.1:1", "--model", "qwen3:8b"), "no model server answers at http://127.0.0.1:1"),
    ],
)
def test_what_cannot_be_measured_is_said_in_a_sentence(tmp_path: Path, wrong: tuple[str, ...], said: str) -> None:
    file = tmp_path / "r.json"
    command = bench("--planners", "goals", "--homes", "15", "--rates", "0", "--json", str(file), *wrong)
    done = subprocess.run(command, env=ENV, capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert said in done.stderr.splitlines()[-1]
    assert not file.exists()


def test_the_picture_shows_every_planner(tmp_path: Path) -> None:
    rows = summary([*TRIALS, trial("emos", 1, 0.0, True), trial("emos", 1, 0.5, False)])
    draw(rows, "emulated", tmp_path / "plot.png")
    image = cv2.imread(str(tmp_path / "plot.png"))
    assert len({tuple(pixel) for pixel in image[430:, :].reshape(-1, 3).tolist() if max(pixel) - min(pixel) > 60}) >= 1
    assert image.shape[1] == 1100


def bench(*arguments: str) -> list[str]:
    return [sys.executable, "-m", "bench", "reasoning", *arguments]


def children_of(pid: int) -> list[str]:
    return [child for task in Path(f"/proc/{pid}/task").iterdir() for child in (task / "children").read_text().split()]


ENV = {**os.environ, "PYTHONPATH": str(Path.cwd())}


def test_it_can_be_ended_at_any_time(tmp_path: Path) -> None:
    command = bench("--planners", "single_shot", "--homes", "6", "--rates", "0", "--json", str(tmp_path / "r.json"))
    run = subprocess.Popen(
        command, env=ENV, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    while not (trials := children_of(run.pid)):
        assert run.poll() is None
        time.sleep(0.05)
    run.send_signal(signal.SIGINT)
    _, said = run.communicate()
    assert run.returncode == 1
    assert "interrupted" in said
    assert not (tmp_path / "r.json").exists()
    assert not any(Path(f"/proc/{pid}").exists() for pid in trials), "nothing goes on behind it"


@pytest.mark.timeout(900)
def test_a_trial_is_a_whole_episode_and_is_not_made_twice(tmp_path: Path) -> None:
    file = tmp_path / "reasoning.json"
    command = bench("--planners", "single_shot", "--homes", "15", "--rates", "0", "--json", str(file))
    done = subprocess.run(command, env=ENV, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    (made,) = json.loads(file.read_text())["trials"]
    assert made["task"]["planner"] == "single_shot"
    assert made["task"]["stand_in"]
    assert made["task"]["model_calls"] > 0
    assert made["success"], made
    assert "emulated" in done.stdout
    assert "say nothing of any model" in done.stdout
    again = subprocess.run(command, env=ENV, capture_output=True, text=True, check=False)
    assert json.loads(file.read_text())["trials"] == [made]
    assert again.returncode == 0


def test_the_page_speaks_of_every_row() -> None:
    page = Path("docs/compare-planners.md").read_text()
    assert [name for name in PLANNERS if f"| `{name}` |" not in page] == []


def test_an_unknown_experiment_is_named() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "bench", "seasoning"], env=ENV, capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert "there is no experiment 'seasoning'" in done.stderr
    assert "reasoning:" in done.stderr
