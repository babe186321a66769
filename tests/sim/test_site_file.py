"""The site file of a generated home says what the owner knows, and nothing of its objects."""

import re
import tomllib
from math import degrees, dist
from pathlib import Path

import pytest

from sim.generator import make_home
from sim.generator.__main__ import main
from sim.generator.site_file import Options, write_site
from wire.catalogue import modelled_types
from wire.site import load_site, parse_site


def test_round_trip(tmp_path: Path) -> None:
    out = tmp_path / "deep" / "site.toml"
    assert main(["--seed", "7", "--out", str(out), "--port", "7555", "--save", 'a"b.rrd', "--robots", "2"]) == 0
    site, scene = load_site(out), make_home(7)
    assert site.name == "home-7"
    assert site.router.endpoint.endswith(":7555")
    assert site.view.save == 'a"b.rrd'
    assert site.sim is not None
    assert site.sim.seed == 7
    assert [r.polygon_m for r in site.room] == [r.polygon_m for r in scene.rooms]
    assert [(w.start_m, w.end_m) for w in site.wall] == [(w.start_m, w.end_m) for w in scene.walls]
    assert [(d.id, d.rooms, d.start_m, d.end_m) for d in site.door] == [
        (d.id, d.rooms, d.start_m, d.end_m) for d in scene.doors
    ]
    for camera, pose in zip(site.camera, scene.cameras, strict=True):
        assert (camera.id, camera.position_enu_m, camera.focal_px) == (pose.id, pose.position_m, pose.focal_px)
        assert camera.yaw_deg == pytest.approx(degrees(pose.yaw_rad), abs=1e-3)
        assert camera.tilt_down_deg == pytest.approx(degrees(pose.tilt_down_rad), abs=1e-3)
    assert [r.start_m for r in site.robot] == [at for at, _ in scene.robot_starts[:2]]
    ids = [p.id for p in site.process]
    assert ids[:5] == ["router", "sim", "hub", "planner", "view"]
    assert ids[5:] == [f"cctv-{k + 1}" for k in range(len(scene.cameras))] + ["dog-1", "dog-2"]


def test_no_word_of_objects() -> None:
    text = write_site(make_home(3), Options(robots=6, spread=True, cctv=False))
    assert not [kind for kind in modelled_types() if re.search(rf"\b{kind}\b", text)]
    assert "[[camera]]" not in text
    assert "cctv-" not in text


def test_faults_are_written_and_checked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "site.toml"
    faults = ("cam-1:frame_loss:0.3", "dog-1:delay:0.5", "fridge-1:wrong_state")
    assert main(["--seed", "7", "--out", str(out), "--smart-appliances", *(f"--fault={f}" for f in faults)]) == 0
    sim = load_site(out).sim
    assert sim is not None
    assert sim.smart_appliances
    assert [(f.device, f.kind, f.probability, f.delay_s, f.prop) for f in sim.fault] == [
        ("cam-1", "frame_loss", 0.3, 0.0, None),
        ("dog-1", "delay", 1.0, 0.5, None),
        ("fridge-1", "wrong_state", 1.0, 0.0, None),
    ]
    for wrong, said in (
        ("cam-1:frameloss", "give DEVICE:KIND"),
        ("cam-1:delay:soon", "soon is no number"),
        ("cam-77:frame_loss", "sim.fault.0.device: cam-77 takes no pictures"),
        ("fridge-1:wrong_state", "set sim.smart_appliances"),
    ):
        with pytest.raises(SystemExit):
            main(["--seed", "7", "--out", str(out), f"--fault={wrong}"])
        assert said in capsys.readouterr().err


def test_too_many_robots() -> None:
    with pytest.raises(ValueError, match="99 robots"):
        write_site(make_home(3), Options(robots=99))


@pytest.mark.parametrize("seed", [0, 4, 7])
def test_a_drone_begins_where_nobody_walks_off(seed: int) -> None:
    site = parse_site(tomllib.loads(write_site(make_home(seed), Options(drones=2))), "t")
    drones = [robot.start_m for robot in site.robot if robot.kind == "drone"]
    walkers = [robot.start_m for robot in site.robot if robot.kind != "drone"]
    assert len(set(drones)) == 2
    assert all(dist(a, b) > 2.0 for a in drones for b in walkers)
