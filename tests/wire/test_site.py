"""Typos in a site file: one sentence that says where."""

from pathlib import Path

import pytest

from wire.site import SiteError, load_site

GOOD = """
name = "home"
[[room]]
id = "kitchen"
name = "Kitchen"
kind = "Kitchen"
polygon_m = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]]
[[camera]]
id = "cam-1"
position_enu_m = [0.0, 0.0, 2.3]
yaw_deg = 45.0
tilt_down_deg = 30.0
width_px = 640
height_px = 480
focal_px = 320.0
[[process]]
id = "hub"
role = "hub"
module = "hub"
"""


def fault(text: str, folder: Path) -> str:
    file = folder / "site.toml"
    file.write_text(text)
    with pytest.raises(SiteError) as caught:
        load_site(file)
    message = str(caught.value)
    assert message.startswith(str(file))
    assert "\n" not in message
    return message


def test_a_good_file(tmp_path: Path) -> None:
    file = tmp_path / "site.toml"
    file.write_text(GOOD)
    site = load_site(file)
    assert site.camera[0].position_enu_m == (0.0, 0.0, 2.3)
    assert site.router.endpoint == "tcp/127.0.0.1:7447"


@pytest.mark.parametrize(
    ("wrong", "right", "named"),
    [
        ('kind = "Kitchen"', 'kind = "Kichen"', "room.0.kind"),
        ("yaw_deg", "yaw_dge", "camera.0.yaw_deg: is missing; camera.0.yaw_dge: unknown field, is yaw_deg meant?"),
        (
            'id = "cam-1"',
            'id = "cam-1"\nroom = "attic"',
            "camera.0.room: there is no room attic; the rooms are kitchen",
        ),
        ("yaw_deg = 45.0", 'yaw_deg = "45"', "camera.0.yaw_deg"),
        ('name = "home"', 'name = "../home"', "name"),
        ('name = "home"', 'name = ""', "name"),
        ('module = "hub"', 'module = "hub"\nargs = ["a\\nb"]', "process.0.args.0"),
        ("[[room]]", '[router]\nendpoint = "tcp/127.0.0.1:99999"\n[[room]]', "router.endpoint: 99999 is no port"),
        ("[[room]]", "[view]\ngrpc_port = 7447\n[[room]]", "router.endpoint and view.grpc_port: the same port 7447"),
        ('id = "hub"', 'id = "Hub!"', "process.0.id"),
        ('role = "hub"', 'role = "hup"', "process.0.role"),
        ("[4.0, 0.0], [4.0, 3.0]", "[4.0, 0.0]", "room.0.polygon_m"),
        ("focal_px = 320.0", "focal_px = nan", "camera.0.focal_px"),
        ('name = "home"', "", "name"),
        ("[[camera]]", "[[kamera]]", "kamera"),
    ],
)
def test_a_typo_is_named_with_its_place(wrong: str, right: str, named: str, tmp_path: Path) -> None:
    assert wrong in GOOD
    assert f": {named}" in fault(GOOD.replace(wrong, right, 1), tmp_path)


SIMULATED = GOOD + "[sim]\nseed = 1\nsmart_appliances = true\n[[sim.fault]]\n"


@pytest.mark.parametrize(
    ("row", "named"),
    [
        ('device = "cam-77"\nkind = "frame_loss"', "device: cam-77 takes no pictures; those that do are cam-1"),
        ('device = "cam-1"\nkind = "delay"', "delay_s: a delay needs a time above 0 s"),
        ('device = "sofa-1"\nkind = "wrong_state"', "device: sofa-1 reports no state; appliances are called"),
        ('device = "cam-1"\nkind = "wrong_state"', "device: cam-1 reports no state"),
        (
            'device = "fridge-1"\nkind = "wrong_state"\nprop = "isToggled"',
            "prop: fridge-1 does not report isToggled; it reports isOpen",
        ),
    ],
)
def test_a_fault_that_would_never_happen_is_refused(row: str, named: str, tmp_path: Path) -> None:
    assert f": sim.fault.0.{named}" in fault(SIMULATED + row, tmp_path)


def test_wrong_states_need_appliances_that_report(tmp_path: Path) -> None:
    row = 'device = "television-1"\nkind = "wrong_state"\nprop = "isToggled"'
    (tmp_path / "good.toml").write_text(SIMULATED + row)
    assert load_site(tmp_path / "good.toml").sim is not None
    assert "sim.fault.0.kind: no appliance reports" in fault(SIMULATED.replace("true", "false") + row, tmp_path)


def test_without_a_simulator_time_is_the_walls(tmp_path: Path) -> None:
    (tmp_path / "good.toml").write_text(GOOD)
    assert load_site(tmp_path / "good.toml").clock.mode == "wall"
    told = GOOD.replace("[[room]]", '[clock]\nmode = "lockstep"\n[[room]]', 1)
    assert "clock.mode: lockstep needs a process with the role sim" in fault(told, tmp_path)


def test_an_id_twice(tmp_path: Path) -> None:
    twice = GOOD + '[[process]]\nid = "hub"\nrole = "hub"\nmodule = "hub"\n'
    assert "process: the id hub stands there 2 times" in fault(twice, tmp_path)


def test_no_toml_at_all(tmp_path: Path) -> None:
    assert "not valid TOML" in fault(GOOD.replace("[[room]]", "[[room"), tmp_path)


def test_no_file(tmp_path: Path) -> None:
    with pytest.raises(SiteError, match="no such site file"):
        load_site(tmp_path / "none.toml")


def test_a_folder_is_no_site_file(tmp_path: Path) -> None:
    with pytest.raises(SiteError, match="cannot be read"):
        load_site(tmp_path)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('[router]\nendpoint = "udp:foo"', "router.endpoint: tcp/HOST:PORT, such as tcp/127.0.0.1:7447 is expected"),
        ('[planner]\nname = "../evil"', "planner.name: one word: at most 32 letters"),
        ('[planner]\nvision = "a b"', "planner.vision"),
        ('[view]\nmemory_limit = "lots"', "view.memory_limit: a size, such as 64MiB is expected"),
    ],
)
def test_what_has_the_wrong_shape_is_told_in_words(line: str, said: str, tmp_path: Path) -> None:
    assert said in fault(f"{GOOD}\n{line}\n", tmp_path)


def test_a_robot_outside_of_the_house(tmp_path: Path) -> None:
    robot = '[[robot]]\nid = "dog-9"\nkind = "quadruped"\nstart_m = [%s, 1.0]\n'
    (tmp_path / "good.toml").write_text(GOOD + robot % "3.0")
    assert load_site(tmp_path / "good.toml").robot[-1].id == "dog-9"
    assert "start_m: (104, 1) m is in no room" in fault(GOOD + robot % "104.0", tmp_path)


FLYING = """
[[robot]]
id = "drone-1"
kind = "drone"
start_m = [3.0, 1.0]
link = "udpin://127.0.0.1:14540"
"""


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ("north_deg = 900.0", "robot.0.north_deg"),
        (FLYING.replace("drone-1", "drone-2"), "the link udpin://127.0.0.1:14540 stands there 2 times"),
        ('[sim]\nseed = 1\nmavlink_out = ["127.0.0.1:99999"]', "sim.mavlink_out.0: 99999 is no port"),
        ('[sim]\nseed = 1\nmavlink_out = ["127.0.0.1:0"]', "sim.mavlink_out.0: 0 is no port"),
    ],
)
def test_a_drone_that_could_not_be_flown(more: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "good.toml").write_text(GOOD + FLYING)
    load_site(tmp_path / "good.toml")
    assert said in fault(GOOD + FLYING + more, tmp_path)


def test_a_camera_with_a_vision_model_needs_one(tmp_path: Path) -> None:
    camera = """
[[camera]]
id = "cam-9"
position_enu_m = [1.0, 1.0, 2.3]
yaw_deg = 0.0
tilt_down_deg = 30.0
width_px = 640
height_px = 480
focal_px = 320.0
perception = "both"
"""
    said = fault(f"{GOOD}\n{camera}", tmp_path)
    assert "perception: both needs a vision model; name one in planner.vision, or set embedded" in said
    site = tmp_path / "site.toml"
    site.write_text(f'{GOOD}\n[planner]\nvision = "qwen2.5vl:7b"\n{camera}')
    assert load_site(site).camera[-1].perception == "both"
