"""Generated homes before the camera, and the command that shows them."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from sim.generator import make_home
from sim.render import make_renderer
from sim.render.still import main, named_cameras


def test_both_renderers_agree_about_a_home():
    scene = make_home(1)
    pair = [make_renderer(scene, "gl"), make_renderer(scene, "bullet")]
    for camera in list(named_cameras(scene).values())[:3]:
        gl, bullet = (renderer.render(camera, with_ids=True).ids for renderer in pair)
        assert np.mean(gl == bullet) >= 0.998, camera
    for renderer in pair:
        renderer.close()


def test_every_fixed_camera_sees_things(tmp_path: Path):
    scene = make_home(2)
    renderer = make_renderer(scene, "gl")
    for name, camera in named_cameras(scene).items():
        ids = renderer.render(camera, with_ids=True).ids
        if name.startswith("cam"):
            assert len(set(np.unique(ids)) & set(scene.bodies)) > 0, name
    renderer.close()


def test_stills_are_written_and_show_the_state_asked_for(tmp_path: Path):
    sheet, plain, running = (tmp_path / name for name in ("sheet.png", "plain.png", "running.png"))
    assert main(["--seed", "2", "--contact-sheet", "--out", str(sheet)]) == 0
    assert cv2.imread(str(sheet)).shape[1] == 3 * 640
    camera = ["--seed", "2", "--camera", "mast-1c"]
    assert main([*camera, "--out", str(plain)]) == 0
    assert main([*camera, "--set", "isToggled", "--out", str(running)]) == 0
    assert cv2.imread(str(plain)).shape == (480, 640, 3)
    assert not np.array_equal(cv2.imread(str(plain)), cv2.imread(str(running)))


def test_a_camera_that_is_not_there_is_named_with_those_that_are(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit):
        main(["--seed", "2", "--camera", "cam-99", "--out", str(tmp_path / "x.png")])
    message = capsys.readouterr().err
    assert "cam-99" in message
    assert "mast-1a" in message
