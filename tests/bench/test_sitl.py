"""What `bench.sitl` measures is told and judged elsewhere: slow is no failure of the measurement."""

import json

import pytest

from bench import sitl

SLOW = {"start_s": 30.0, "start_processor_s": 20.0, "core_share_per_vehicle": 2.0, "answer_ms": 500.0}


def test_slow_figures_are_reported_and_no_error(monkeypatch, capsys) -> None:
    monkeypatch.setattr(sitl, "measure", lambda vehicles: SLOW)
    assert sitl.main(["--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"vehicles": 1, **SLOW}
    assert sitl.main([]) == 0
    assert "answer_ms" in capsys.readouterr().out


@pytest.mark.parametrize("count", ["0", "-1", "11", "many"])
def test_a_count_of_vehicles_that_cannot_be_flown_gets_a_sentence(count, capsys) -> None:
    with pytest.raises(SystemExit) as ended:
        sitl.main(["--vehicles", count])
    assert ended.value.code == 2
    assert "1 to 10" in capsys.readouterr().err
