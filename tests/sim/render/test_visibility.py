"""Leaving out what cannot be seen never changes a picture."""

from math import pi

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sim.render.instances import Instances, PartsOf
from sim.render.meshes import BOX, DETAILS, TRIANGLE, vertices
from sim.render.picture import Camera
from sim.render.polygons import area, contains, triangles
from sim.render.portals import Portals
from sim.render.view import visible_batches
from sim.scene import Scene
from wire.frames import project

corner = st.tuples(st.floats(-5, 5).map(lambda v: round(v, 2)), st.floats(-5, 5).map(lambda v: round(v, 2)))


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    x=st.floats(0.3, 7.7),
    y=st.floats(0.3, 3.7),
    z=st.floats(0.3, 2.4),
    yaw_rad=st.floats(-pi, pi),
    tilt_rad=st.floats(0.0, pi / 2),
)
def test_a_body_in_the_same_room_and_in_the_picture_is_drawn(
    home: Scene, parts_of: PartsOf, x: float, y: float, z: float, yaw_rad: float, tilt_rad: float
):
    instances = Instances(home, parts_of)
    camera = Camera((x, y, z), yaw_rad, tilt_rad, 320, 240, 160.0)
    batches = visible_batches(instances, Portals(home, instances.finder), camera)
    drawn = {int(key) for batch in batches for key in batch.rows["id"]}
    for body in home.bodies.values():
        spot_m = (*body.position_m[:2], body.position_m[2] + body.size_m[2] / 2.0)
        seen = project(spot_m, camera.position_m, yaw_rad, tilt_rad, 320, 240, 160.0)
        in_picture = seen is not None and seen[2] > 0.1 and 0.0 <= seen[0] <= 320.0 and 0.0 <= seen[1] <= 240.0
        if in_picture and (body.position_m[0] < 4.0) == (x < 4.0):
            assert body.key in drawn


@pytest.mark.parametrize(
    ("x", "yaw_rad", "rooms"), [(2.0, 0.0, 0b11), (2.0, pi, 0b01), (6.0, pi, 0b11), (6.0, 0.0, 0b10), (-1.0, pi, -1)]
)
def test_rooms_are_seen_through_doors_only(home: Scene, parts_of: PartsOf, x: float, yaw_rad: float, rooms: int):
    portals = Portals(home, Instances(home, parts_of).finder)
    visible = int(portals.visible(Camera((x, 2.1, 1.3), yaw_rad, 0.2, 320, 240, 160.0)))
    assert visible == rooms % (1 << 64)


def test_a_camera_beside_the_door_does_not_see_through_it(home: Scene, parts_of: PartsOf):
    portals = Portals(home, Instances(home, parts_of).finder)
    assert portals.visible(Camera((0.2, 3.8, 1.3), pi / 4, 0.2, 320, 240, 160.0)) == 0b01


def test_only_the_rows_of_a_changed_body_are_made_again(home: Scene, parts_of: PartsOf):
    instances = Instances(home, parts_of)
    instances.changed.clear()
    before = instances.rows()
    home.bodies[3].position_m = (1.0, 1.0, 0.0)
    instances.update(home.bodies[3])
    assert instances.changed == {3}
    assert instances.rows().shape == before.shape
    assert set(np.unique(before["id"][before != instances.rows()])) == {3}


@given(st.lists(corner, min_size=3, max_size=3, unique=True), st.floats(0.1, 0.9))
def test_triangles_cover_an_l_shape_or_a_triangle(points: list[tuple[float, float]], notch: float):
    l_shape = ((0.0, 0.0), (2.0, 0.0), (2.0, notch), (notch, notch), (notch, 2.0), (0.0, 2.0))
    for polygon in (l_shape, l_shape[::-1], tuple(points)):
        pieces = triangles(polygon)
        assert sum(abs(area(piece)) for piece in pieces) == pytest.approx(abs(area(polygon)))
    middles = [(sum(x for x, _ in piece) / 3.0, sum(y for _, y in piece) / 3.0) for piece in triangles(l_shape)]
    assert all(contains(l_shape, middle) for middle in middles)


@pytest.mark.parametrize("shape", range(TRIANGLE))
@pytest.mark.parametrize("detail", range(DETAILS))
def test_triangles_face_outwards_and_fill_the_unit_cube(shape: int, detail: int):
    mesh = vertices(shape, detail).astype(float)
    a, b, c = (mesh[i::3, :3] for i in range(3))
    facing = np.cross(b - a, c - a)
    assert np.all((facing * (a + b + c)).sum(axis=1) > 0.0)
    assert np.all((facing * mesh[::3, 3:6]).sum(axis=1) > 0.0)
    assert mesh[:, 2].max() == pytest.approx(0.5)
    assert mesh[:, 2].min() == pytest.approx(-0.5)
    volume = (a * np.cross(b, c)).sum() / 6.0
    assert volume == pytest.approx({BOX: 1.0}.get(shape, volume))
