"""Plans on the wire: up, down, cleared, lost, out of order, refused and abandoned."""

import math

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.mavlink.missions import AGAIN_S, TRIES
from tests.sim.mavlink.bed import Bed

HOME = (47.397742, 8.545594)


def item(client, seq, command=16, frame=6, x=HOME[0], y=HOME[1], z=1.5, kind=0, current=0, whole=True, p1=0.0):
    if whole:
        args = (1, 1, seq, frame, command, current, 1, p1, 0, 0, 0, round(x * 1e7), round(y * 1e7), z, kind)
        client.mav.mission_item_int_send(*args)
    else:
        client.mav.mission_item_send(1, 1, seq, frame, command, current, 1, p1, 0, 0, 0, x, y, z, kind)


def asked(client, seq, span_s=3.0):
    names = ("MISSION_REQUEST", "MISSION_REQUEST_INT")
    while True:
        found = [m for m in client.heard if m.get_type() in names and m.seq == seq]
        if found:
            return found[0]
        span_s -= 0.02
        assert span_s > 0, f"item {seq} not asked for; {client.heard[-3:]}"
        client.bed.advance(0.02)


def upload(client, points, kind=0, whole=True, **how):
    client.forget()
    client.mav.mission_count_send(1, 1, len(points), kind)
    for seq, (x, y, z) in enumerate(points):
        asked(client, seq)
        item(client, seq, x=x, y=y, z=z, kind=kind, whole=whole, **how)
    return client.wait("MISSION_ACK").type


def download(client, kind=0):
    client.forget()
    client.mav.mission_request_list_send(1, 1, kind)
    out = []
    for seq in range(client.wait("MISSION_COUNT").count):
        client.forget()
        client.mav.mission_request_int_send(1, 1, seq, kind)
        out.append(client.wait("MISSION_ITEM_INT"))
    client.mav.mission_ack_send(1, 1, 0, kind)
    return out


POINTS = [(HOME[0] + 1e-5 * k, HOME[1] - 1e-5 * k, 1.0 + k / 10) for k in range(6)]


@pytest.mark.parametrize("whole", [True, False])
def test_what_is_uploaded_can_be_downloaded(bed, whole):
    client = bed.client()
    bed.advance(3.0)
    assert upload(client, POINTS, whole=whole) == 0
    kind = "MISSION_REQUEST_INT" if bed.firmware.now.row.mission_request == "int" else "MISSION_REQUEST"
    assert [m.seq for m in client.all(kind)] == list(range(6))
    got = download(client)
    first = 1 if bed.firmware.now.row.home_is_item_0 else 0
    assert len(got) == len(POINTS)
    for message, (x, y, z) in list(zip(got, POINTS, strict=True))[first:]:
        slack = 1e-7 if whole else 1e-5
        assert message.x / 1e7 == pytest.approx(x, abs=slack)
        assert message.y / 1e7 == pytest.approx(y, abs=slack)
        assert message.z == pytest.approx(z, abs=1e-5)
    client.forget()
    client.mav.mission_request_send(1, 1, 2, 0)
    assert client.wait("MISSION_ITEM").x == pytest.approx(POINTS[2][0], abs=1e-5)


def test_lost_item_is_asked_for_again(bed):
    client = bed.client()
    bed.advance(2.0)
    client.forget()
    client.mav.mission_count_send(1, 1, 2, 0)
    asked(client, 0)
    client.forget()
    bed.advance(AGAIN_S - 0.1)
    assert not [m for m in client.heard if "MISSION_REQUEST" in m.get_type()]
    asked(client, 0, 0.3)
    item(client, 0)
    asked(client, 1)
    item(client, 0)
    item(client, 1)
    assert client.wait("MISSION_ACK").type == 0


def test_client_that_vanishes_leaves_the_old_plan(bed):
    client, other = bed.client(), bed.client("udp", 200)
    bed.advance(2.0)
    assert upload(client, POINTS) == 0
    client.mav.mission_count_send(1, 1, 50, 0)
    asked(client, 0)
    bed.clients.remove(client)
    client.socket.close()
    other.forget()
    other.mav.mission_count_send(1, 1, 2, 0)
    assert other.wait("MISSION_ACK").type == mav.MAV_MISSION_DENIED
    bed.advance(AGAIN_S * (TRIES + 1) + 0.5)
    assert any("timed out" in text for text in other.texts())
    assert len(download(other)) == len(POINTS)
    assert upload(other, POINTS[:3]) == 0


def test_wrong_sequence_and_wrong_kind(bed):
    client = bed.client()
    bed.advance(2.0)
    client.forget()
    item(client, 0)
    assert client.wait("MISSION_ACK").type == mav.MAV_MISSION_ERROR
    client.forget()
    client.mav.mission_count_send(1, 1, 3, 0)
    asked(client, 0)
    item(client, 2)
    assert client.wait("MISSION_ACK").type == mav.MAV_MISSION_INVALID_SEQUENCE
    item(client, 0)
    asked(client, 1)
    client.forget()
    client.mav.mission_count_send(1, 1, 3, 7)
    assert client.wait("MISSION_ACK").type == mav.MAV_MISSION_UNSUPPORTED
    client.forget()
    client.mav.mission_count_send(1, 1, 60000, 0)
    assert client.wait("MISSION_ACK").type == mav.MAV_MISSION_NO_SPACE
    client.forget()
    client.mav.mission_request_int_send(1, 1, 900, 0)
    assert client.wait("MISSION_ACK").type == mav.MAV_MISSION_INVALID_SEQUENCE


def test_cancel_by_the_client(bed):
    client = bed.client()
    bed.advance(2.0)
    client.mav.mission_count_send(1, 1, 3, 0)
    asked(client, 0)
    client.mav.mission_ack_send(1, 1, mav.MAV_MISSION_OPERATION_CANCELLED, 0)
    bed.advance(0.1)
    client.forget()
    bed.advance(2.0)
    assert not [m for m in client.heard if m.get_type().startswith("MISSION_REQUEST")]


@pytest.mark.parametrize("bad", [math.nan, math.inf, 1e30])
def test_bad_item_refuses_the_whole(bed, bad):
    client = bed.client()
    bed.advance(2.0)
    assert upload(client, POINTS) == 0
    client.forget()
    client.mav.mission_count_send(1, 1, 2, 0)
    asked(client, 0)
    item(client, 0)
    asked(client, 1)
    item(client, 1, z=bad)
    assert client.wait("MISSION_ACK").type != 0
    assert len(download(client)) == len(POINTS)


def test_fence_and_rally_are_kept_apart_and_cleared(bed):
    client = bed.client()
    bed.advance(2.0)
    assert upload(client, POINTS) == 0
    corners = [(HOME[0] + dx, HOME[1] + dy, 0.0) for dx, dy in ((-1e-4, -1e-4), (-1e-4, 1e-4), (1e-4, 1e-4))]
    assert upload(client, corners, kind=1, command=5001, frame=5, p1=3.0) == 0, client.texts()
    assert upload(client, [(*HOME, 1.0)], kind=2, command=5100) == 0, client.texts()
    assert [len(download(client, kind)) for kind in (0, 1, 2)] == [6, 3, 1]
    client.forget()
    client.mav.mission_clear_all_send(1, 1, 1)
    assert client.wait("MISSION_ACK").mission_type == 1
    assert [len(download(client, kind)) for kind in (0, 1, 2)] == [6, 0, 1]
    client.forget()
    client.mav.mission_clear_all_send(1, 1, 255)
    assert client.wait("MISSION_ACK").type == 0
    home = 1 if bed.firmware.now.row.home_is_item_0 else 0
    assert [len(download(client, kind)) for kind in (0, 1, 2)] == [home, 0, 0]
    assert upload(client, []) == 0


def test_a_rally_point_at_zero_is_nowhere(bed):
    client = bed.client()
    bed.advance(2.0)
    assert upload(client, [(0.0, 0.0, 1.0)], kind=2, command=5100) == mav.MAV_MISSION_INVALID_PARAM5_X
    bed.advance(0.2)
    assert any("Rally points item 0" in text for text in client.texts()), client.texts()
    assert download(client, 2) == []


def test_a_fence_that_holds_nothing_is_refused(bed):
    client = bed.client()
    bed.advance(2.0)
    line = [(HOME[0] + 1e-5 * k, HOME[1] + 2e-5 * k, 0.0) for k in range(3)]
    for corners in (line, [(*HOME, 0.0)] * 3):
        assert upload(client, corners, kind=1, command=5001, frame=5, p1=3.0) == mav.MAV_MISSION_INVALID
        bed.advance(0.2)
        assert "on one line" in "".join(client.texts()), client.texts()
    assert upload(client, [(*HOME, 0.0)], kind=1, command=5003, frame=5, p1=1e-6) == mav.MAV_MISSION_INVALID_PARAM1
    assert download(client, 1) == []


def test_set_current(bed):
    client = bed.client()
    bed.advance(2.0)
    assert upload(client, POINTS) == 0
    client.forget()
    client.mav.mission_set_current_send(1, 1, 3)
    current = client.wait("MISSION_CURRENT", such=lambda m: m.seq == 3)
    home = int(bed.firmware.now.row.home_is_item_0)
    assert current.total == len(POINTS) - home, "home is not counted"
    assert current.mission_state == mav.MISSION_STATE_NOT_STARTED
    client.forget()
    client.mav.mission_set_current_send(1, 1, 99)
    assert client.wait("MISSION_ACK").type == mav.MAV_MISSION_INVALID_SEQUENCE


def test_a_place_to_go_to_now(bed):
    client = bed.client()
    client.fly()
    item(client, 0, frame=3, x=HOME[0] + 2e-5, z=1.5, current=2, whole=False)
    ack = client.wait("MISSION_ACK")
    if bed.firmware.now.row.name == "ardupilot":
        assert ack.type == 0
        client.wait("LOCAL_POSITION_NED", 15.0, lambda m: m.x > 1.5)


def test_end_of_a_mission_is_told(bed):
    client = bed.client()
    client.fly()
    assert upload(client, [(*HOME, 1.5), (HOME[0] + 1e-5, HOME[1], 1.5)]) == 0
    assert client.command(mav.MAV_CMD_MISSION_START) == 0
    client.wait("MISSION_ITEM_REACHED", 15.0, lambda m: m.seq == 1)
    client.wait("MISSION_CURRENT", 3.0, lambda m: m.mission_state == mav.MISSION_STATE_COMPLETE)
    assert upload(client, POINTS) == 0
    client.forget()
    assert client.wait("MISSION_CURRENT").mission_state != mav.MISSION_STATE_COMPLETE


def test_without_a_mission_it_says_so(bed):
    client = bed.client()
    current = client.wait("MISSION_CURRENT")
    assert (current.total, current.mission_state) == (0, mav.MISSION_STATE_NO_MISSION)


@pytest.mark.parametrize(
    ("place", "result"),
    [
        ((95.0, HOME[1], 1.5), mav.MAV_MISSION_INVALID_PARAM5_X),
        ((HOME[0], 190.0, 1.5), mav.MAV_MISSION_INVALID_PARAM6_Y),
        ((HOME[0], HOME[1] + 1.0, 1.5), mav.MAV_MISSION_INVALID_PARAM6_Y),
        ((*HOME, 1e6), mav.MAV_MISSION_INVALID_PARAM7),
    ],
)
def test_a_place_that_cannot_be_is_refused_by_the_number_that_is_wrong(bed, place, result):
    client = bed.client()
    bed.advance(2.0)
    client.mav.mission_count_send(1, 1, 2, 0)
    asked(client, 0)
    item(client, 0)
    asked(client, 1)
    item(client, 1, x=place[0], y=place[1], z=place[2])
    assert client.wait("MISSION_ACK").type == result


def test_arducopter_has_a_part_of_its_mission_written_anew():
    """As MAVProxy does to move one waypoint; what is flown to stays so."""
    with Bed("ardupilot") as bed:
        client = bed.client()
        bed.advance(3.0)
        assert upload(client, POINTS) == 0
        client.mav.mission_set_current_send(1, 1, 4)
        bed.advance(0.1)
        client.forget()
        client.mav.mission_write_partial_list_send(1, 1, 2, 3, 0)
        for seq in (2, 3):
            asked(client, seq)
            item(client, seq, x=HOME[0] + 3e-5, y=HOME[1], z=3.0 + seq)
        assert client.wait("MISSION_ACK").type == 0
        assert [round(m.z, 2) for m in download(client)][1:] == [1.1, 5.0, 6.0, 1.4, 1.5]
        client.forget()
        assert client.wait("MISSION_CURRENT").seq == 4
        for first, last in ((4, 6), (-1, 2), (3, 2)):
            client.forget()
            client.mav.mission_write_partial_list_send(1, 1, first, last, 0)
            assert client.wait("MISSION_ACK").type == mav.MAV_MISSION_ERROR
        assert len(download(client)) == len(POINTS)
