"""The task of a home: not done yet, done when the home is changed accordingly, and understood by a planner."""

from functools import lru_cache

import pytest

from planners.scripted.goals import read_goals
from sim.generator import make_home
from sim.scene import Scene
from sim.task import make_task, name_of
from sim.truth import Truth
from wire.catalogue import modelled_types
from wire.goals import holds, select
from wire.messages.goal import Goal
from wire.messages.truth import TruthTask
from wire.messages.world import WorldState

SEEDS = tuple(range(20))
HOMES = 5


@lru_cache(maxsize=HOMES)
def home(seed: int) -> Scene:
    return make_home(seed)


def truth(scene: Scene) -> WorldState:
    return Truth(scene).world({}, frozenset(), frozenset(), 0.0, 1)


def given(seed: int) -> tuple[Scene, TruthTask]:
    """A few homes, each with several tasks."""
    scene = home(seed % HOMES)
    return scene, make_task(scene, seed)


@pytest.mark.parametrize("seed", SEEDS)
def test_nothing_is_done_at_the_start(seed: int) -> None:
    scene, task = given(seed)
    assert 1 <= len(task.goals) <= 3
    assert task == make_task(scene, seed)
    assert not any(holds(goal, truth(scene)) for goal in task.goals)


@pytest.mark.parametrize("seed", SEEDS)
def test_doing_it_makes_it_true(seed: int) -> None:
    scene, task = given(seed)
    world = truth(scene)
    for goal in task.goals:
        world = do(goal, world)
    assert all(holds(goal, world) for goal in task.goals)


def do(goal: Goal, world: WorldState) -> WorldState:
    """The world with a goal brought about by hand."""
    chosen = {o.id for o in select(goal.subject, world)}
    assert len(chosen) == 1 or goal.subject.count is None
    props = {"off": ("isToggled", False), "open": ("isOpen", True), "closed": ("isOpen", False)}
    objects = []
    for obj in world.objects:
        if obj.id in chosen and goal.predicate in props:
            name, value = props[goal.predicate]
            changed = obj.props[name].model_copy(update={"value": value})
            obj = obj.model_copy(update={"props": {**obj.props, name: changed}})
        elif obj.id in chosen and goal.predicate == "at":
            assert goal.object is not None
            obj = obj.model_copy(update={"room": goal.object.room, "receptacle": None})
        elif obj.id in chosen:
            assert goal.object is not None
            (place,) = select(goal.object, world)
            obj = obj.model_copy(update={"room": place.room, "receptacle": place.id})
        objects.append(obj)
    return world.model_copy(update={"objects": tuple(objects)})


@pytest.mark.parametrize("seed", SEEDS)
def test_a_planner_reads_the_same_goals(seed: int) -> None:
    scene, task = given(seed)
    read = read_goals(task.instruction, truth(scene))
    meant = {(g.predicate, g.subject.type, g.object and (g.object.type, g.object.room)) for g in task.goals}
    assert {(g.predicate, g.subject.type, g.object and (g.object.type, g.object.room)) for g in read} == meant


def test_every_type_has_a_name_of_its_own() -> None:
    names = [name_of(kind) for kind in modelled_types()]
    assert len(set(names)) == len(names)


def test_nobody_is_sent_for_what_cannot_be_grasped() -> None:
    # In this home the only alarm clock stands behind a television, where no robot's eye gets to it.
    scene = make_home(6)
    assert all(goal.subject.type != "AlarmClock" for goal in make_task(scene, 6).goals)
