"""How long a full battery lasts: as the autopilot reckons, or learned from the drain."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from devices.drone.endurance import Endurance


@given(full_s=st.floats(100.0, 3000.0), begun=st.floats(0.5, 1.0))
def test_learned_from_a_charge_that_is_told_in_hundredths(full_s: float, begun: float) -> None:
    endurance, worst = Endurance(), 0.0
    for second in range(int(full_s * (begun - 0.1))):
        charge = round(begun - second / full_s, 2)
        endurance.take(float(second), True, charge, None)
        if endurance.full_s is not None and begun - second / full_s < begun - 0.15:
            worst = max(worst, abs(endurance.full_s / full_s - 1.0))
    assert endurance.full_s is not None
    assert worst < 0.2


@given(full_s=st.floats(100.0, 3000.0), charge=st.floats(0.2, 1.0))
def test_what_the_autopilot_reckons_is_believed(full_s: float, charge: float) -> None:
    endurance = Endurance()
    for second in range(40):
        endurance.take(float(second), True, charge, charge * full_s)
    assert endurance.full_s == pytest.approx(full_s, rel=1e-6)
    for second in range(40, 60):  # the drain, which says other things, is not heeded
        endurance.take(float(second), True, charge - 0.01 * (second - 39), None)
    assert endurance.full_s == pytest.approx(full_s, rel=1e-6)


def test_nothing_is_said_before_something_is_known() -> None:
    endurance = Endurance()
    for second in range(100):
        endurance.take(float(second), False, 0.9, None)
    assert endurance.full_s is None, "on the ground"
    for second in range(100, 105):
        endurance.take(float(second), True, 0.9, 700.0)
    assert endurance.full_s is None, "the rotors have only begun to turn"
    for second in range(105, 300):
        endurance.take(float(second), True, None, 700.0)
    assert endurance.full_s is None, "the charge is not told"


def test_a_battery_that_was_changed_begins_anew_and_what_is_known_is_kept_on_the_ground() -> None:
    endurance = Endurance()
    for second in range(100):
        endurance.take(float(second), True, 1.0 - second / 500, None)
    known = endurance.full_s
    assert known == pytest.approx(500.0, rel=0.05)
    endurance.take(100.0, False, 0.8, None)
    endurance.take(101.0, True, 1.0, None)
    for second in range(102, 200):
        endurance.take(float(second), True, 1.0, None)
    assert endurance.full_s == known
