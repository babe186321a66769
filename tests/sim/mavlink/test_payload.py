"""Camera and gimbal in missions: pictures, series, distances and angles as they are reached, and what is refused."""

import math
from itertools import pairwise

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.mavlink.camera import CAMERA
from sim.mavlink.endpoint import Aboard, Endpoint
from sim.mavlink.gimbal import GIMBAL
from tests.sim.mavlink.bed import Bed
from tests.sim.mavlink.test_missions import HOME, asked

NAN = math.nan
METRE = math.degrees(1 / 6371000.0)
HOME_ITEM = (16, (0, 0, 0, 0), 0, 0, 0.0)


def place(north: float, height: float = 1.5, command: int = 16):
    return (command, (0, 0, 0, NAN), round((HOME[0] + north * METRE) * 1e7), round(HOME[1] * 1e7), height)


def do(command: int, *params: float, x: int = 0, z: float = 0.0):
    return (command, (*params, *(0.0,) * (4 - len(params))), x, 0, z)


def upload(client, plan) -> int:
    """With home before it where the firmware has that; the result."""
    plan = [HOME_ITEM, *plan] if client.bed.firmware.now.row.home_is_item_0 else plan
    client.forget()
    client.mav.mission_count_send(1, 1, len(plan), 0)
    for seq, (command, params, x, y, z) in enumerate(plan):
        if client.all("MISSION_ACK"):
            break
        frame = 6 if command in (16, 31) else 2
        asked(client, seq)
        client.mav.mission_item_int_send(1, 1, seq, frame, command, 0, 1, *params, x, y, z, 0)
        client.bed.advance(0.05)
    result = client.wait("MISSION_ACK").type
    client.bed.advance(0.1)
    return int(result)


def fly(client, plan) -> list:
    """To the mission's end; the pictures."""
    assert upload(client, plan) == 0, client.texts()
    client.fly()
    assert client.command(mav.MAV_CMD_MISSION_START) == 0
    last = len(plan) - 1 + client.bed.firmware.plans.mission.first
    client.wait("MISSION_ITEM_REACHED", 40.0, lambda m: m.seq == last)
    client.bed.advance(0.1)
    return client.all("CAMERA_IMAGE_CAPTURED")


def pitch_deg(message) -> float:
    w, x, y, z = message.q
    return math.degrees(math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x)))))


def test_a_picture_downwards_and_a_series(bed):
    client = bed.client()
    pictures = fly(
        client,
        [
            place(0.0),
            do(1001, 245, 190, -1, -1),
            do(1000, -60, 0, NAN, NAN, x=12),
            do(93, 1.0),
            do(2000, 0, 0, 1),
            place(1.0),
            do(530, 0, 2),
            do(2000, 0, 0.2, 0),
            do(93, 1.1),
            do(2001),
            place(2.0),
            do(203, x=1),
        ],
    )
    assert [each.image_index for each in pictures] == list(range(1, len(pictures) + 1))
    assert all(each.get_srcComponent() == CAMERA and each.capture_result == 1 for each in pictures)
    norths = [(each.lat / 1e7 - HOME[0]) / METRE for each in pictures]
    assert norths[0] == pytest.approx(0.0, abs=0.3)
    assert len(pictures) in (7, 8), "one, a series of 1.1 s, and one at the end"
    assert all(north == pytest.approx(1.0, abs=0.4) for north in norths[1:-1])
    assert norths[-1] == pytest.approx(2.0, abs=0.4)
    assert pitch_deg(client.all("GIMBAL_DEVICE_ATTITUDE_STATUS")[-1]) == pytest.approx(-60, abs=1)
    assert client.all("GIMBAL_MANAGER_STATUS")[-1].primary_control_sysid == 245
    assert client.command(512, 260, target=(1, CAMERA)) == 0
    assert client.wait("CAMERA_SETTINGS").mode_id == mav.CAMERA_MODE_IMAGE_SURVEY


def test_pictures_by_distance(bed):
    """As a survey has them: the first at once, none once they are switched off."""
    client = bed.client()
    plan = [place(0.0), do(93, 2.0), do(206, 0.5, 0, 1), place(3.0), do(206, 0), place(4.5)]
    pictures = fly(client, plan)
    norths = [(each.lat / 1e7 - HOME[0]) / METRE for each in pictures]
    assert norths[0] == pytest.approx(0.0, abs=0.3)
    assert all(b - a == pytest.approx(0.5, abs=0.15) for a, b in pairwise(norths)), norths
    assert 2.4 < norths[-1] < 3.3


def test_px4_takes_no_pictures_by_distance_where_the_mission_is_left():
    for firmware, goes_on in (("px4", False), ("ardupilot", True)):
        with Bed(firmware) as bed:
            client = bed.client()
            fly(client, [place(0.0), do(206, 0.3, 0, 0)])
            row = bed.firmware.now.row
            mode = row.modes["hold" if firmware == "px4" else "offboard"]
            assert client.command(176, 1, *((4, 3) if firmware == "px4" else (mode,))) == 0
            client.forget()
            nan = NAN
            client.mav.command_int_send(
                1, 1, 3, 192, 0, 0, -1, 1, 0, nan, round((HOME[0] + 2 * METRE) * 1e7), round(HOME[1] * 1e7), 1.5
            )
            client.wait("LOCAL_POSITION_NED", 10.0, lambda m: m.x > 1.5)
            assert bool(client.all("CAMERA_IMAGE_CAPTURED")) is goes_on


@pytest.mark.parametrize("shown", [True, False])
def test_older_commands_go_to_the_autopilot(shown):
    """Also where camera and gimbal do not show themselves."""
    with Bed("ardupilot") as bed:
        node = bed.endpoint.nodes[0]
        row = node.craft.personality
        bed.endpoint = Endpoint([Aboard(node.craft.autopilot, row, camera=shown)], bed.endpoint.links)
        client = bed.client()
        bed.advance(2.0)
        assert client.command(203, 0, 0, 0, 0, 1) == 0
        assert client.all("COMMAND_ACK")[0].get_srcComponent() == 1
        client.wait("CAMERA_IMAGE_CAPTURED", 0.5)
        assert client.command(205, -90, 0, 30) == 0
        bed.advance(2.0)
        gimbal = bed.endpoint.nodes[0]._payload.gimbal
        assert (math.degrees(gimbal.aim.pitch_rad), math.degrees(gimbal.aim.yaw_rad)) == pytest.approx(
            (-90, 30), abs=0.1
        )
        assert client.command(204, 1) == 0
        bed.advance(2.0)
        assert (gimbal.aim.pitch_rad, gimbal.aim.yaw_rad) == pytest.approx((0, 0), abs=0.01)
        assert client.command(205, 90) == mav.MAV_RESULT_DENIED
        assert client.command(206, -7) == mav.MAV_RESULT_DENIED
        assert bool({m.get_srcComponent() for m in client.all("HEARTBEAT")} & {CAMERA, GIMBAL}) <= shown


@pytest.mark.parametrize("shown", [True, False])
def test_a_hidden_camera_flies_missions_too(shown):
    with Bed("ardupilot") as bed:
        node = bed.endpoint.nodes[0]
        hidden = Aboard(node.craft.autopilot, node.craft.personality, camera=shown)
        bed.endpoint = Endpoint([hidden], bed.endpoint.links)
        client = bed.client()
        assert len(fly(client, [place(0.0), do(2000, 0, 0, 1), do(93, 0.5)])) == 1


@pytest.mark.parametrize(
    ("bad", "result", "words"),
    [
        (do(2500), mav.MAV_MISSION_UNSUPPORTED, "no video"),
        (do(183, 1, 1500), mav.MAV_MISSION_UNSUPPORTED, "cannot do that"),
        (do(2000, 0, -1, 1), mav.MAV_MISSION_INVALID_PARAM2, "param 2"),
        (do(2000, 0, 1, 1e9), mav.MAV_MISSION_INVALID_PARAM3, "param 3"),
        (do(530, 0, 1), mav.MAV_MISSION_INVALID_PARAM2, "param 2"),
        (do(206, -3), mav.MAV_MISSION_INVALID_PARAM1, "param 1"),
        (do(1000, 80, 0), mav.MAV_MISSION_INVALID_PARAM1, "param 1"),
        (do(1000, -20, 270), mav.MAV_MISSION_INVALID_PARAM2, "param 2"),
        (do(1001, 900), mav.MAV_MISSION_INVALID_PARAM1, "param 1"),
        (do(204, 3), mav.MAV_MISSION_INVALID_PARAM1, "param 1"),
        (do(205, -20, 30, 0, z=2), mav.MAV_MISSION_INVALID_PARAM2, "param 2"),
        (do(205, -95, z=2), mav.MAV_MISSION_INVALID_PARAM1, "param 1"),
    ],
)
def test_what_they_cannot_do_is_refused_when_it_is_uploaded(bed, bad, result, words):
    client = bed.client()
    bed.advance(2.0)
    assert upload(client, [place(0.0), bad, place(1.0)]) == result
    assert words in "".join(client.texts()), client.texts()


def test_plain_numbers_of_an_item_come_back_as_they_went_up(bed):
    """Params 5 and 6 of a command without a place are no degrees, whatever the frame."""
    client = bed.client()
    bed.advance(2.0)
    assert upload(client, [place(0.0), do(203, x=1), do(1000, -30, 0, NAN, NAN, x=12)]) == 0
    first = bed.firmware.plans.mission.first
    for seq, x in ((1, 1), (2, 12)):
        client.forget()
        client.mav.mission_request_int_send(1, 1, first + seq, 0)
        assert client.wait("MISSION_ITEM_INT").x == x
