"""What is in the pictures: the right thing at the right pixel, the same with either renderer."""

import logging
from dataclasses import replace
from math import pi
from typing import Literal

import numpy as np
import pytest

from sim.render import Camera, Renderer, choose, make_renderer
from sim.render.instances import PartsOf
from sim.render.picture import NOTHING_ID, ROBOT_ID, RenderError
from sim.scene import Scene
from wire.frames import project

KINDS: tuple[Literal["gl"], Literal["bullet"]] = ("gl", "bullet")

VIEWS = [
    Camera((x, y, 2.3), yaw_rad, tilt_rad, 640, 480, 320.0)
    for x, y, yaw_rad, tilt_rad in (
        (0.3, 0.3, pi / 4, 0.6),
        (3.7, 0.3, 0.75 * pi, 0.5),
        (3.7, 3.7, -0.75 * pi, 0.7),
        (0.3, 3.7, -pi / 4, 0.4),
        (4.3, 0.3, pi / 4, 0.6),
        (7.7, 3.7, -0.8 * pi, 0.45),
        (4.0, 2.1, 0.0, 1.2),
        (2.0, 2.0, 0.3, pi / 2 - 0.1),
    )
] + [
    Camera((x, 2.1, 1.3), yaw_rad, tilt_rad, 320, 240, 160.0, "dog-1")
    for x, yaw_rad, tilt_rad in ((2.0, 0.0, 0.1), (3.6, pi, 0.5), (4.0, 0.1, 0.3), (6.0, pi, 0.0))
]


@pytest.fixture(params=KINDS)
def renderer(request: pytest.FixtureRequest, home: Scene, parts_of: PartsOf):
    made = make_renderer(home, request.param, parts_of)
    yield made
    made.close()


def test_both_renderers_give_each_pixel_to_the_same_thing(home: Scene, parts_of: PartsOf):
    pair = [make_renderer(home, kind, parts_of) for kind in KINDS]
    for made in pair:
        made.set_robot("dog-1", (2.6, 2.4, 0.0), 2.5)
        made.set_robot("dog-2", (6.5, 2.4, 0.0), -1.0, holding=True)
    for camera in VIEWS:
        gl, bullet = (made.render(camera, with_ids=True, with_depth=True) for made in pair)
        assert gl.ids is not None
        assert gl.depth_m is not None
        assert np.mean(gl.ids == bullet.ids) >= 0.998, camera
        assert np.percentile(np.abs(gl.depth_m - bullet.depth_m), 99) < 0.005, camera
    for made in pair:
        made.close()


def test_a_small_ball_is_where_the_projection_says(renderer: Renderer, home: Scene):
    camera = Camera((0.5, 0.5, 2.2), 0.6, 0.5, 640, 480, 320.0)
    for key, spot_m in enumerate([(2.5, 2.0, 0.2), (3.4, 1.2, 1.1), (1.6, 1.7, 1.8)], start=2):
        ball = replace(home.bodies[4], key=key, position_m=spot_m, size_m=(0.06, 0.06, 0.06))
        renderer.update(ball)
        picture = renderer.render(camera, with_ids=True, with_depth=True)
        rows, columns = np.nonzero(picture.ids == key)
        expected = project((spot_m[0], spot_m[1], spot_m[2] + 0.03), camera.position_m, 0.6, 0.5, 640, 480, 320.0)
        assert expected is not None
        assert columns.mean() + 0.5 == pytest.approx(expected[0], abs=0.5)
        assert rows.mean() + 0.5 == pytest.approx(expected[1], abs=0.5)
        assert picture.depth_m[rows, columns].min() == pytest.approx(expected[2] - 0.03, abs=0.01)


def test_depth_is_along_the_optical_axis(renderer: Renderer):
    camera = Camera((6.0, 2.3, 2.0), 0.0, pi / 2, 320, 240, 160.0)
    depth_m = renderer.render(camera, with_depth=True).depth_m
    assert depth_m is not None
    assert depth_m[110:130, 150:170] == pytest.approx(2.0, abs=0.002)


def test_a_lit_television_changes_the_picture(renderer: Renderer, home: Scene):
    camera = Camera((2.5, 2.0, 1.2), pi, 0.1, 320, 240, 160.0)
    before = renderer.render(camera, with_ids=True)
    home.bodies[1].props["isToggled"] = True
    renderer.update(home.bodies[1])
    after = renderer.render(camera, with_ids=True)
    assert np.array_equal(before.ids, after.ids)
    screen = before.ids == 1
    change = np.abs(after.rgb.astype(int) - before.rgb).sum(axis=2)
    assert change[screen].mean() > 150.0
    assert not change[~screen].any()


def test_a_body_that_moves_or_goes_leaves_its_place(renderer: Renderer, home: Scene):
    camera = VIEWS[0]
    assert (renderer.render(camera, with_ids=True).ids == 4).any()
    renderer.update(replace(home.bodies[4], position_m=(7.0, 0.6, 0.0)))
    assert not (renderer.render(camera, with_ids=True).ids == 4).any()
    renderer.update(home.bodies[4])
    assert (renderer.render(camera, with_ids=True).ids == 4).any()
    renderer.update(replace(home.bodies[4], gone=True))
    assert not (renderer.render(camera, with_ids=True).ids == 4).any()


def test_a_robot_is_seen_by_others_and_not_by_its_own_camera(renderer: Renderer):
    renderer.set_robot("dog-1", (2.0, 2.0, 0.0), 0.0)
    camera = Camera((2.2, 2.0, 1.3), 0.0, 0.8, 320, 240, 160.0)
    assert (renderer.render(camera, with_ids=True).ids == ROBOT_ID).any()
    assert not (renderer.render(replace(camera, carrier="dog-1"), with_ids=True).ids == ROBOT_ID).any()
    assert (renderer.render(camera, with_ids=True).ids == ROBOT_ID).any()


def test_nothing_is_outside(renderer: Renderer):
    picture = renderer.render(Camera((-3.0, 2.0, 1.0), pi, 0.0, 64, 48, 32.0), with_ids=True, with_depth=True)
    assert np.all(picture.ids == NOTHING_ID)
    assert np.all(picture.depth_m == 0.0)


def test_ids_and_depth_come_only_when_asked_for(renderer: Renderer):
    picture = renderer.render(VIEWS[0])
    assert picture.rgb.shape == (480, 640, 3)
    assert picture.ids is None
    assert picture.depth_m is None


def test_pybullet_takes_over_with_one_sentence(
    home: Scene, parts_of: PartsOf, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
):
    monkeypatch.setattr(choose, "gl_fault", lambda: "no device")
    with caplog.at_level(logging.WARNING):
        made = make_renderer(home, "auto", parts_of)
    made.close()
    assert made.name == "bullet"
    assert [record.levelname for record in caplog.records] == ["WARNING"]
    assert "no device" in caplog.text
    with pytest.raises(RenderError, match="no device"):
        make_renderer(home, "gl", parts_of)


def test_a_driver_that_does_not_start_is_found_out(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere")
    choose.gl_fault.cache_clear()
    fault = choose.gl_fault()
    choose.gl_fault.cache_clear()
    assert fault is not None


def test_renderers_of_two_homes_do_not_mix(home: Scene, parts_of: PartsOf):
    other_home = replace(home, bodies={2: replace(home.bodies[2], look=9)})
    one, other = make_renderer(home, "gl", parts_of), make_renderer(other_home, "gl", parts_of)
    first = one.render(VIEWS[1]).rgb, other.render(VIEWS[1]).rgb
    again = one.render(VIEWS[1]).rgb, other.render(VIEWS[1]).rgb
    one.close()
    last = other.render(VIEWS[1]).rgb
    other.close()
    assert np.array_equal(first, again)
    assert np.array_equal(last, first[1])
    assert not np.array_equal(first[0], first[1])


def test_a_picture_is_drawn_again_only_when_something_in_it_changed(home: Scene, parts_of: PartsOf):
    renderer, camera = make_renderer(home, "gl", parts_of), VIEWS[2]
    renderer.set_robot("dog-1", (6.5, 2.4, 0.0), 0.0)
    content, _ = renderer.render_changed(camera, None)
    renderer.set_robot("dog-1", (6.8, 2.4, 0.0), 0.5)  # in the other room
    assert renderer.render_changed(camera, content) is None
    assert renderer.render_changed(replace(camera, yaw_rad=0.8), content) is not None
    renderer.set_robot("dog-1", (2.6, 2.4, 0.0), 2.5)
    drawn = renderer.render_changed(camera, content)
    assert drawn is not None
    assert np.array_equal(drawn[1].rgb, renderer.render(camera).rgb)
    assert renderer.render_changed(camera, drawn[0]) is None
    home.bodies[4].look += 1
    renderer.update(home.bodies[4])
    assert renderer.render_changed(camera, drawn[0]) is not None
    renderer.close()


def test_pybullets_pictures_are_always_drawn(home: Scene, parts_of: PartsOf):
    renderer = make_renderer(home, "bullet", parts_of)
    content, picture = renderer.render_changed(VIEWS[8], None, with_depth=True)
    again = renderer.render_changed(VIEWS[8], content, with_depth=True)
    assert again is not None
    assert np.array_equal(picture.rgb, again[1].rgb)
    assert picture.depth_m is not None
    renderer.close()
