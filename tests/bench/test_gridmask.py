"""The comparison with and without the grid: the detector and a stand-in on the same pictures, all runs shown."""

import pytest

from bench.gridmask import Run, embedded, evaluate, modelled, table
from devices.vision.cube_detector import CubeDetector
from planners.asking import Question
from tests.ollama_double.brains import looks
from tests.ollama_double.dials import Dials
from tests.ollama_double.in_process import InProcess


@pytest.fixture(scope="module")
def runs() -> list[Run]:
    stand_ins: set[str] = set()
    model = InProcess(looks.make(Dials()))
    lookers = [("embedded", embedded(CubeDetector())), ("brain", modelled(model, stand_ins, "brain"))]
    runs = evaluate(lookers, 6, 0, stand_ins)
    assert len(model.questions) == 12
    assert all(question.schema and question.pictures for question in model.questions)
    return runs


def test_every_looker_has_a_row_with_the_grid_and_one_without(runs: list[Run]) -> None:
    assert [(r.name, r.gridded) for r in runs] == [
        ("embedded", True),
        ("embedded", False),
        ("brain", True),
        ("brain", False),
    ]
    assert len({r.figures["things"] for r in runs}) == 1
    assert [r.stand_in for r in runs] == [False, False, True, True]
    assert table(runs).count("(stand-in, no model)") == 2


def test_cubes_are_found_named_and_placed(runs: list[Run]) -> None:
    for run in runs[:2]:
        figures = run.figures
        assert (figures["recall"] or 0.0) > 0.8, run
        assert (figures["identity_right"] or 0.0) > 0.85, run
        assert (figures["deviation_cells_median"] or 9.0) < 0.15, run
        assert (figures["corrected_m_median"] or 9.0) < 0.05, run


def test_attitude_and_height_matter_more_than_the_grid(runs: list[Run]) -> None:
    for run in runs[:2]:
        assert (run.figures["flat_m_median"] or 0.0) > 1.5 * (run.figures["corrected_m_median"] or 9.0), run


def test_replies_that_are_none_are_counted() -> None:
    def broken(question: Question) -> str:
        return '{"objects":['

    runs = evaluate([("broken", modelled(InProcess(broken), set(), "broken"))], 1, 0, set())
    assert [r.figures["valid_replies"] for r in runs] == [0.0, 0.0]
    assert [r.figures["recall"] for r in runs] == [0.0, 0.0]
    assert "- | - | -" in table(runs)
