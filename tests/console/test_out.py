"""A folder that cannot be written is one sentence, not a traceback."""

import pytest
from typer.testing import CliRunner

from console.app import app


@pytest.mark.parametrize("words", [["demo"], ["demo-seeds", "--seeds", "1-1"]])
def test_results_that_cannot_be_written(words: list[str]) -> None:
    done = CliRunner().invoke(app, [*words, "--out", "/proc/none"])
    assert done.exit_code == 1
    assert done.output == "error: /proc/none: No such file or directory\n"
