"""The physics is as fast as promised."""

from sim.bench import measure
from sim.generator import make_home


def test_the_furnished_home_is_a_hundred_times_faster_than_real_time():
    report = measure(make_home(1), seconds=3.0)
    assert report["compound"]["real_time_factor"] >= 100.0
    assert report["compound_with_legs"]["real_time_factor"] >= 15.0
    assert report["speed_up"] > 3.0
    assert report["furniture"] + report["small_things"] == len(make_home(1).bodies)
