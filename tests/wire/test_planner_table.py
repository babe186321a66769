"""The table `[planner]`: what may stand in it, and what is said of what may not."""

import re
import tomllib
from typing import get_args

import pytest

from tests.pages import ROOT, blocks
from wire.messages.plan import CallOutcome
from wire.planner_table import Budget, PlannerChoice
from wire.site import Site, SiteError, parse_site

SITE = """
name = "toy"
[[room]]
id = "hall"
name = "Hall"
kind = "Other"
polygon_m = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]
[[process]]
id = "planner"
role = "planner"
module = "planners"
[planner]
"""


def read(text: str) -> Site:
    return parse_site(tomllib.loads(SITE + text), "toy.toml")


def test_a_site_that_says_nothing_plans_without_a_model() -> None:
    assert read("").planner == PlannerChoice()
    assert read("").planner.name == "scripted"
    assert read("").planner.longest_s == 60.0


def test_everything_that_can_be_said() -> None:
    planner = read(
        'name = "goals"\nmodel = "hf.co/someone/Some-Model_8B.gguf:Q4_K_M"\nhost = "http://box.lan:11434"\nnum_ctx = 4096\n'
        'timeout_s = 30.0\nload_timeout_s = 60.0\nseed = 7\nreplies = "keep"\nfallback = false\n'
        "[planner.budget]\ntokens = 1000\ncalls = 3\nseconds = 45.0\n"
    ).planner
    assert planner.budget.calls == 3
    assert planner.longest_s == 45.0 + 30.0 + 30.0 + 60.0


def test_the_page_shows_a_table_that_can_be_read() -> None:
    (table,) = blocks("language-models.md", "toml")
    said = tomllib.loads(table)["planner"]
    assert PlannerChoice.model_validate(said).name == "goals"
    assert {*said, "budget"} == set(PlannerChoice.model_fields)
    assert set(said["budget"]) == set(Budget.model_fields)


def test_the_page_names_every_outcome() -> None:
    rows = re.findall(r"^\| (\w+) \|", (ROOT / "docs" / "language-models.md").read_text(), re.M)
    assert set(rows) - {"outcome"} == set(get_args(CallOutcome)) - {"ok"}


@pytest.mark.parametrize("host", ["", "box", "box:11434", "127.0.0.1:11434", "[::1]:11434", "https://box.lan/ollama"])
def test_addresses(host: str) -> None:
    assert read(f'host = "{host}"').planner.host == host


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("budget = 3", "planner.budget: a map with the fields tokens, calls, seconds is expected"),
        ('model = ""', "planner.model: a model as `ollama list` names it, such as qwen3:8b is expected"),
        ('model = "../x"', "planner.model: a model as `ollama list` names it"),
        ('host = "ftp://box"', "planner.host: an address such as http://127.0.0.1:11434"),
        ('host = "a b"', "planner.host: an address such as"),
        ("num_ctx = 100", "planner.num_ctx: input should be greater than or equal to 512"),
        ("timeout_s = 0.0", "planner.timeout_s: input should be greater than 0"),
        ('replies = "always"', "planner.replies: input should be 'off', 'keep' or 'only'"),
        ("seed = -1", "planner.seed: input should be greater than or equal to 0"),
        ("[planner.budget]\ncalls = -1", "planner.budget.calls: input should be greater than or equal to 0"),
        ("[planner.budget]\ntoken = 1", "planner.budget.token: unknown field, is tokens meant?"),
        ('modell = "x"', "planner.modell: unknown field, is model meant?"),
    ],
)
def test_what_is_wrong_is_said_in_a_sentence(text: str, said: str) -> None:
    with pytest.raises(SiteError) as caught:
        read(text)
    assert said in str(caught.value)
