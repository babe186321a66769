"""What a drone tells of how far it has got never goes back, over all the parts of one goal."""

import pytest

from tests.devices.drone.scripted import STEP_S, Flown

GOALS = {
    "goto": {"point_m": (7.0, 3.0)},
    "construct_map": {"room": "west", "params": {"spacing_m": 1.5}},
    "orbit": {"point_m": (2.0, 2.0), "params": {"radius_m": 0.8}},
    "follow_path": {"params": {"way_m": "1 1 1.2; 2 2 1.4; 3 2 1.2"}},
}


@pytest.mark.parametrize("action", GOALS)
def test_progress_goes_from_nothing_to_nearly_all_and_never_back(action: str) -> None:
    flown = Flown()
    flown.begin(action, **GOALS[action])
    told = [flown.worker.progress[0]]
    for _ in range(round(200.0 / STEP_S)):
        flown.tick()
        outcome = flown.worker.work(flown.now_s)
        told.append(flown.worker.progress[0])
        if outcome is not None:
            break
    assert outcome is not None
    assert outcome.code == "ok", outcome.reason
    assert told[0] == 0.0
    assert told == sorted(told)
    assert 0.8 < told[-1] <= 1.0
    assert len({round(share, 1) for share in told}) > 4, "told on the way"


def test_the_next_goal_begins_anew() -> None:
    flown = Flown()
    flown.do("goto", point_m=(3.0, 1.0))
    flown.begin("goto", point_m=(1.0, 1.0))
    assert flown.worker.progress[0] == 0.0
