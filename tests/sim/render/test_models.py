"""Every type of object in every state, as cameras see it."""

from math import pi

import numpy as np
import pytest

from sim.render import Camera, Picture, Renderer, make_renderer
from sim.scene import Body, Room, Scene
from wire.catalogue import PROP_FLAG, PROPS, catalogue, modelled_types

STATES = [(name, prop) for name in modelled_types() for prop in PROPS if catalogue()[name].can(PROP_FLAG[prop])]
VIEWS = [
    Camera((2.0, 2.1, 1.6), 0.0, 0.55, 320, 240, 200.0),
    Camera((6.0, 2.1, 1.6), pi, 0.55, 320, 240, 200.0),
    Camera((5.4, 2.1, 2.3), pi, 0.80, 320, 240, 200.0),
]
SPOT_M = (4.0, 2.0)


@pytest.fixture(scope="module")
def renderer():
    room = Room("a", "Room", "Kitchen", ((0.0, 0.0), (8.0, 0.0), (8.0, 4.0), (0.0, 4.0)), 0, (0.9, 0.9, 0.9))
    made = make_renderer(Scene(0, (room,), (), (), {}, (), ()), "gl")
    yield made
    made.close()


def _looks(renderer: Renderer, name: str, props: dict[str, bool], camera: Camera) -> Picture:
    size_m = catalogue()[name].size_m
    base_m = 0.6 if size_m[2] < 0.5 else 0.0
    renderer.update(Body(1, name, (*SPOT_M, base_m), 0.4, size_m, 5, props))
    picture = renderer.render(camera, with_ids=True)
    renderer.update(Body(1, name, (*SPOT_M, base_m), 0.4, size_m, 5, props, gone=True))
    return picture


@pytest.mark.parametrize("name", modelled_types())
def test_every_type_is_seen(renderer: Renderer, name: str):
    assert all(np.sum(_looks(renderer, name, {}, view).ids == 1) > 20 for view in VIEWS)


@pytest.mark.parametrize(("name", "prop"), STATES)
def test_every_state_shows(renderer: Renderer, name: str, prop: str):
    bases: list[dict[str, bool]] = [{}]
    if prop != "isOpen" and catalogue()[name].can("openable"):
        bases.append({"isOpen": True})
    assert max(_change(renderer, name, base, prop, view) for base in bases for view in VIEWS) > 0.05


def _change(renderer: Renderer, name: str, base: dict[str, bool], prop: str, view: Camera) -> float:
    """Part of a thing's pixels that differ clearly between the two values of a property."""
    plain, other = (_looks(renderer, name, {**base, prop: value}, view) for value in (False, True))
    differ = np.abs(plain.rgb.astype(int) - other.rgb).sum(axis=2) > 24
    return float(np.sum(differ) / max(int(np.sum(plain.ids == 1)), 1))
