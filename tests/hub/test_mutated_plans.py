"""Plans with one fault each: all are refused, and for the fault that was made; without it none is."""

from functools import cache
from random import Random

import pytest

from devices.drone.skills import SKILLS as DRONE
from devices.quadruped.skills import SKILLS as QUADRUPED
from hub.ability import Ability
from hub.checks import faults
from planners.scripted.planner import ScriptedPlanner
from tests.hub import mutations_of_deeds  # noqa: F401
from tests.hub.mutations import MUTATIONS, Case
from tests.planners.test_tasks import SENTENCES, furnished
from tests.planners.toy import ROOMS, site
from wire.messages.plan import PlanRequest
from wire.messages.world import RobotState

HOMES = 72
EACH = 2
"""So often each mutation is made of one plan."""
DOG = Ability(tuple(QUADRUPED), 3.0, {name: skill.card().parameters for name, skill in QUADRUPED.items()})
FLYER = Ability(tuple(DRONE), 0.0, {name: skill.card().parameters for name, skill in DRONE.items()})


@cache
def cases() -> tuple[Case, ...]:
    """Plans of the scripted planner in homes where cameras see all, some or no rooms."""
    found = []
    for seed in range(HOMES):
        cameras = (tuple(id for id, _, _ in ROOMS), ("kitchen", "living-room"), ())[seed % 4 % 3]
        world = furnished(seed, cameras).world()
        drone = RobotState(
            id="drone-1", kind="drone", position_enu_m=(3.0, 3.0, 0.0), yaw_deg=0.0, status="idle",
            skills=tuple(DRONE), stamp_s=1.0, room="kitchen",
        )  # fmt: skip
        world = world.model_copy(update={"robots": (*world.robots, drone)})
        for sentence in (SENTENCES[seed % len(SENTENCES)], SENTENCES[(seed * 5 + 3) % len(SENTENCES)]):
            request = PlanRequest(task=f"t-{seed}", epoch=1, instruction=sentence, world=world, now_s=1.0)
            plan = ScriptedPlanner(site()).make_plan(request).plan
            if plan is not None and plan.nodes:
                abilities = {r.id: DOG for r in world.robots if r.kind == "quadruped"} | {"drone-1": FLYER}
                found.append(Case(plan, world, abilities, site()))
    return tuple(found)


def objections(case: Case) -> list[str]:
    return faults(case.plan, case.world, case.abilities, case.floor)


def test_no_good_plan_is_blamed() -> None:
    assert len(cases()) > HOMES
    assert all(objections(case) == [] for case in cases())


def mutants(name: str) -> list[Case]:
    """What a mutation makes of every plan that has what it needs."""
    made = (
        MUTATIONS[name](Random(f"{name} {number} {again}"), case)
        for number, case in enumerate(cases())
        for again in range(EACH)
    )
    return [case for case in made if case is not None]


@pytest.mark.parametrize("name", MUTATIONS)
def test_every_mutated_plan_is_refused_for_what_was_done_to_it(name: str) -> None:
    mutated = mutants(name)
    assert len(mutated) >= 20, "too few plans have what this mutation needs"
    for case in mutated:
        found = objections(case)
        assert any(all(word in text for word in case.culprits) for text in found), (case.culprits, found)


def test_there_are_thousands_of_them() -> None:
    assert sum(len(mutants(name)) for name in MUTATIONS) >= 1000
