"""`logs --json`: one object a line."""

import json
from pathlib import Path

import pytest

from console.logs import show_logs


def test_every_line_is_an_object(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "hub.log").write_text("old\nhub is on the mesh\n")
    (tmp_path / "sim.log").write_text('said "so"\n')
    show_logs(sorted(tmp_path.glob("*.log")), follow=False, lines=1, as_json=True)
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert rows == [{"process": "hub", "line": "hub is on the mesh"}, {"process": "sim", "line": 'said "so"'}]
