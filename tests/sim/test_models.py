"""Every type of the vocabulary has a model that shows its state and stays within its box."""

from math import cos, sin

import pytest

from sim.models import MODELS, parts, surfaces
from sim.scene import Body, Part, Vec3
from wire.catalogue import PROP_FLAG, catalogue, modelled_types

SLACK_M = 0.035
SPREADS = {
    ("Fridge", True),
    ("Microwave", True),
    ("Box", True),
    ("LaundryHamper", True),
    ("Book", True),
    ("Toilet", True),
}


def make_body(kind: str, size_m: Vec3 | None = None, look: int = 3, **props: bool) -> Body:
    own = {p: props.get(p, False) for p, flag in PROP_FLAG.items() if catalogue()[kind].can(flag)}
    return Body(1, kind, (0.0, 0.0, 0.0), 0.0, size_m or catalogue()[kind].size_m, look, own)


def corners(part: Part) -> list[Vec3]:
    c, s, cp, sp = cos(part.yaw_rad), sin(part.yaw_rad), cos(part.pitch_rad), sin(part.pitch_rad)
    found = []
    for i in range(8):
        x, y, z = (part.size_m[k] * (0.5 if i >> k & 1 else -0.5) for k in range(3))
        x, z = cp * x + sp * z, -sp * x + cp * z
        cx, cy, cz = part.centre_m
        found.append((cx + c * x - s * y, cy + s * x + c * y, cz + z))
    return found


def test_every_type_has_a_model() -> None:
    assert sorted(MODELS) == list(modelled_types())


@pytest.mark.parametrize("kind", modelled_types())
def test_state_shows(kind: str) -> None:
    for prop in make_body(kind).props:
        extra = {"isOpen": True} if kind == "Laptop" and prop == "isToggled" else {}
        off, on = make_body(kind, **{**extra, prop: False}), make_body(kind, **{**extra, prop: True})
        assert parts(off) != parts(on)


@pytest.mark.parametrize("kind", modelled_types())
def test_same_body_looks_the_same_and_looks_differ(kind: str) -> None:
    assert parts(make_body(kind)) == parts(make_body(kind))
    assert len({parts(make_body(kind, look=look)) for look in range(8)}) > 3


@pytest.mark.parametrize("kind", modelled_types())
@pytest.mark.parametrize("which", ["size_p10_m", "size_m", "size_p90_m"])
def test_parts_stay_in_the_box(kind: str, which: str) -> None:
    size_m = getattr(catalogue()[kind], which)
    bodies = [make_body(kind, size_m)]
    bodies += [make_body(kind, size_m, **{prop: True}) for prop in bodies[0].props]
    for body in bodies:
        made = parts(body)
        assert 3 <= len(made) <= 20
        if (kind, body.props.get("isOpen")) in SPREADS:
            continue
        for part in made:
            assert all(s > 0.0 for s in part.size_m)
            for x, y, z in _extent(part):
                assert abs(x) <= size_m[0] / 2.0 + SLACK_M, (body.props, part)
                assert abs(y) <= max(size_m[1], 0.06) / 2.0 + SLACK_M, (body.props, part)
                assert -0.01 <= z <= size_m[2] + SLACK_M, (body.props, part)


def _extent(part: Part) -> list[Vec3]:
    """Corners of a box; for round things, which do not reach their corners, only the middle and the poles."""
    if part.shape == "box":
        return corners(part)
    return [part.centre_m] if part.pitch_rad else [(x, y, z) for x, y, z in _poles(part)]


def _poles(part: Part) -> list[Vec3]:
    x, y, z = part.centre_m
    dx, dy, dz = (s / 2.0 for s in part.size_m)
    if part.yaw_rad:
        return [(x, y, z - dz), (x, y, z + dz)]
    return [(x - dx, y, z), (x + dx, y, z), (x, y - dy, z), (x, y + dy, z), (x, y, z - dz), (x, y, z + dz)]


@pytest.mark.parametrize("kind", modelled_types())
def test_receptacles_carry(kind: str) -> None:
    body = make_body(kind)
    found = surfaces(body)
    assert bool(found) == catalogue()[kind].can("receptacle")
    for surface in found:
        assert surface.size_m[0] > 0.0
        assert surface.size_m[1] > 0.0
        assert 0.0 <= surface.height_m <= body.size_m[2]
        assert abs(surface.centre_m[0]) + surface.size_m[0] / 2.0 <= body.size_m[0] / 2.0 + 0.01
