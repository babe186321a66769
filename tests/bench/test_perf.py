"""Each section of `justw perf` runs from an empty folder and says what its claims read. How fast is not asked here."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.walk
@pytest.mark.timeout(300)
@pytest.mark.parametrize("section", ["sim.flight.bench", "bench.sitl"])
def test_a_section_says_what_its_claims_read(section, tmp_path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "bench.perf", "--json", "--only", section],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    claims = json.loads((tmp_path / "out" / "perf" / "perf.json").read_text())[section]["claims"]
    assert claims
    assert [row["name"] for row in claims if "error" in row] == []
