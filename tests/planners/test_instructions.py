"""The corpus of instructions: what the grammar reads is exact, what it cannot read it refuses, the model's share too."""

from collections import Counter

import pytest

from planners.scripted.goals import read_goals
from planners.scripted.syntax import Unclear
from tests.planners.emulated_model import EmulatedModel
from tests.planners.figures import outcome
from tests.planners.home import home_world
from tests.planners.instructions import Row, rows, written

STYLES = (
    *("terse", "polite", "typo", "chatty", "conditional", "indirect", "implicit", "negation", "count", "order"),
    *("several", "synonym", "ambiguous", "impossible", "not-instruction", "injection"),
)


def by(reader: str) -> list[Row]:
    return [row for row in rows() if row.by == reader]


def read(row: Row) -> str:
    try:
        return written(read_goals(row.say, home_world()))
    except Unclear as unclear:
        return "?" if unclear.question else "!" if unclear.final else "out of grammar"


@pytest.mark.parametrize("row", by("grammar"), ids=lambda row: row.say)
def test_the_grammar_reads_its_share_exactly(row: Row) -> None:
    assert read(row) == row.want


@pytest.mark.parametrize("row", by("model"), ids=lambda row: row.say)
def test_the_rest_is_refused_by_the_grammar_and_translated_by_the_model(row: Row) -> None:
    assert read(row) == "out of grammar"
    assert outcome(row, EmulatedModel()) == row.want


def test_what_the_grammar_settles_costs_nothing() -> None:
    for row in by("grammar"):
        model = EmulatedModel()
        assert outcome(row, model) == row.want
        assert model.said == []


def test_the_corpus_is_large_and_of_many_styles() -> None:
    styles = Counter(row.style for row in rows())
    assert len({row.say for row in rows()}) == len(rows()) >= 200
    assert set(styles) == set(STYLES)
    assert min(styles.values()) >= 8
    assert sum(row.refused for row in rows()) >= 60
    assert len(by("model")) >= 100
