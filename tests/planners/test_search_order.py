"""Search orders against the best of all orders, and the walking distances that they rest on."""

from itertools import permutations
from random import Random

from planners.tasks.search_order import Hunt, expected_s, search_order
from planners.tasks.travel import UNREACHABLE_M, Travel
from tests.planners.toy import site


def hunt(seed: int, rooms: int, robots: int, peak: float) -> Hunt:
    rng = Random(seed)
    at = [(rng.uniform(0, 20), rng.uniform(0, 10)) for _ in range(rooms)]
    starts = [(rng.uniform(0, 20), rng.uniform(0, 10)) for _ in range(robots)]
    weights = [rng.gammavariate(peak, 1.0) + 1e-6 for _ in range(rooms)]

    def way(a: tuple[float, float], b: tuple[float, float]) -> float:
        return (abs(a[0] - b[0]) + abs(a[1] - b[1])) / 0.5

    return Hunt(
        tuple(w / sum(weights) for w in weights),
        tuple(rng.uniform(15.0, 40.0) for _ in range(rooms)),
        tuple(0.0 for _ in range(robots)),
        tuple(tuple(way(s, p) for p in at) for s in starts),
        tuple(tuple(way(a, b) for b in at) for a in at),
    )


def test_one_robot_is_near_the_best_order() -> None:
    ratios = []
    for seed in range(24):
        case = hunt(seed, 6, 1, (0.3, 1.0, 10.0)[seed % 3])
        best = min(expected_s(case, 0, order) for order in permutations(range(6)))
        ratios.append(expected_s(case, 0, search_order(case)[0]) / best)
    assert sum(ratios) / len(ratios) <= 1.1
    assert max(ratios) <= 1.3


def test_rooms_are_split_without_loss_or_repetition() -> None:
    for seed in range(12):
        case = hunt(seed, 7, 3, 1.0)
        orders = search_order(case)
        assert sorted(room for order in orders for room in order) == list(range(7))
        together = sum(expected_s(case, robot, order) for robot, order in enumerate(orders))
        alone = hunt(seed, 7, 1, 1.0)
        assert together < expected_s(alone, 0, search_order(alone)[0])


def test_ways_lead_through_doors() -> None:
    travel = Travel(site())
    near = travel.metres((1.0, 1.0), (4.0, 1.0))
    assert 3.0 <= near < 4.0
    through = travel.metres((1.0, 1.0), (9.0, 1.0))
    assert through > 8.0
    assert travel.metres((9.0, 1.0), (1.0, 1.0)) == through
    assert travel.metres((1.0, 8.0), (9.0, 8.0)) > travel.metres((1.0, 8.0), (4.0, 1.0))


def test_a_room_without_a_door_is_the_last_to_be_tried() -> None:
    walled = site().model_copy(update={"door": site().door[:1]})
    assert Travel(walled).metres((1.0, 1.0), (1.0, 8.0)) > UNREACHABLE_M
