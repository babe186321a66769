"""The measurement of the physics says what it measured, and of what."""

from math import isfinite

from sim.bench import measure
from sim.generator import make_home


def test_three_ways_to_simulate_one_furnished_home_are_compared():
    report = measure(make_home(1), seconds=0.5)
    factors = [report[way]["real_time_factor"] for way in ("compound", "compound_with_legs")]
    assert all(isfinite(factor) and factor > 0.0 for factor in factors)
    assert isfinite(report["speed_up"])
    assert report["furniture"] + report["small_things"] == len(make_home(1).bodies)
