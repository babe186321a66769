"""Links and frames: several clients, garbage, lost ends, and signatures."""

import random
import socket
import struct
from itertools import pairwise

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.mavlink.links import GONE_BYTES, MAX_PEERS, SILENT_S, LinkError, TcpServer, UdpIn, UdpOut
from tests.sim.mavlink.bed import Bed

KEY, OTHER_KEY = bytes(range(32)), bytes(32)


def test_port_in_use_says_so():
    first = TcpServer(0)
    with pytest.raises(LinkError, match=f"TCP port {first.port} is in use"):
        TcpServer(first.port)
    first.close()
    udp = UdpIn(0)
    with pytest.raises(LinkError, match="in use"):
        UdpIn(udp.port)
    udp.close()


def test_leaving_the_machine_needs_a_word():
    with pytest.raises(LinkError, match="leaves this machine"):
        UdpOut("192.0.2.1", 14550)


def test_address_of_another_machine():
    with pytest.raises(LinkError, match="cannot be opened"):
        TcpServer(0, "192.0.2.1")


def test_sent_to_an_address_unasked():
    ground = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    ground.bind(("127.0.0.1", 0))
    ground.settimeout(2.0)
    with Bed("px4") as bed:
        link = UdpOut("127.0.0.1", ground.getsockname()[1])
        bed.endpoint.links.append(link)
        bed.advance(1.2)
        station = mav.MAVLink(None, 255, 190)
        data, vehicle = ground.recvfrom(4096)
        names = [m.get_type() for m in station.parse_buffer(data)]
        while "HEARTBEAT" not in names:
            names += [m.get_type() for m in station.parse_buffer(ground.recv(4096)) or ()]
        request = mav.MAVLink_command_long_message(1, 1, mav.MAV_CMD_REQUEST_MESSAGE, 0, 148, 0, 0, 0, 0, 0, 0)
        ground.sendto(request.pack(station), vehicle)
        bed.advance(0.1)
        while "AUTOPILOT_VERSION" not in names:
            names += [m.get_type() for m in station.parse_buffer(ground.recv(4096)) or ()]
        ground.close()


def test_several_clients_each_with_its_own_sequence(bed):
    clients = [bed.client("tcp", 245), bed.client("tcp", 246), bed.client("udp", 247)]
    bed.advance(1.0)
    for client in clients:
        client.command(mav.MAV_CMD_REQUEST_MESSAGE, 148)
        bed.advance(0.5)
        frames = [m.get_msgbuf() for m in client.heard]  # what the dialect does not know has a number, too
        numbers = [frame[4] for frame in frames if frame[6] == 1]
        assert len(numbers) > 30
        assert all((b - a) & 0xFF == 1 for a, b in pairwise(numbers))
    clients[0].socket.close()
    bed.clients.remove(clients[0])
    bed.advance(0.5)
    assert len(bed.tcp.peers()) == 1


def test_client_that_does_not_read_is_let_go(bed):
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as made:
        made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        made.connect(("127.0.0.1", bed.tcp.port))
        bed.advance(0.1)
        peer = bed.tcp.peers()[0]
        text = mav.MAVLink_statustext_message(6, b"x" * 50)
        for _ in range(GONE_BYTES // 30):
            peer.send(text, 1, 1, urgent=False)
        assert peer.counts.dropped
        for _ in range(GONE_BYTES // 30):
            peer.send(text, 1, 1)
        bed.advance(0.1)
        assert bed.tcp.peers() == []


def test_silent_clients_make_room_for_who_comes_later(bed):
    """The longest silent first; who speaks stays, and so does who has just come."""
    speaker = bed.client()
    bed.advance(0.1)
    silent = [bed.client() for _ in range(MAX_PEERS - 1)]
    for client in silent:
        client.beats = False
    bed.advance(0.5)
    assert len(bed.tcp.peers()) == MAX_PEERS
    early = bed.client("tcp", 250)
    early.beats = False
    bed.advance(0.2)
    assert not early.heard, "nobody has been silent for long"
    bed.clients.remove(early)
    silent[1].mav.heartbeat_send(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, 4)
    bed.advance(SILENT_S + 0.1)
    late = bed.client("tcp", 251)
    late.wait("HEARTBEAT", 2.0)
    assert late.command(mav.MAV_CMD_REQUEST_MESSAGE, 148) == 0
    assert len(bed.tcp.peers()) == MAX_PEERS
    assert speaker.command(mav.MAV_CMD_REQUEST_MESSAGE, 148) == 0
    for gone, client in enumerate(silent):
        client.forget()
        bed.advance(0.3)
        assert bool(client.heard) is (gone != 0)
    early.socket.close()


def test_udp_client_that_is_silent_is_forgotten(bed):
    client = bed.client("udp")
    bed.advance(1.0)
    client.beats = False
    bed.advance(10.0)
    assert bed.udp.peers()
    bed.advance(6.0)
    assert bed.udp.peers() == []


def test_garbage_does_not_disturb(bed):
    client, vandal = bed.client(), bed.client("udp", 66)
    client.fly()
    rng = random.Random(4)
    whole = mav.MAVLink_command_long_message(1, 1, 400, 0, 0, 21196, 0, 0, 0, 0, 0).pack(vandal.mav)
    for _ in range(100):
        for kind in range(10):
            data = bytearray(rng.randbytes(rng.randrange(1, 300)))
            if kind < 4:
                data = bytearray(whole)
                data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
            elif kind < 6:
                data = bytearray(whole[: rng.randrange(1, len(whole))])
            elif kind < 7:
                data[:3] = b"\xfd\xff\x00"
            vandal.write(bytes(data))
        bed.advance(0.01)
    client.forget()
    bed.advance(2.0)
    assert abs(client.all("LOCAL_POSITION_NED")[-1].z + 1.5) < 0.3
    assert len(client.all("HEARTBEAT")) >= 4
    assert client.command(mav.MAV_CMD_REQUEST_MESSAGE, 148) == 0


def test_frame_cut_short_does_not_eat_the_next(bed):
    client = bed.client("udp")
    bed.advance(0.5)
    request = mav.MAVLink_command_long_message(1, 1, mav.MAV_CMD_REQUEST_MESSAGE, 0, 148, 0, 0, 0, 0, 0, 0)
    client.write(request.pack(client.mav)[:-6])
    client.write(request.pack(client.mav))
    assert client.wait("COMMAND_ACK", 0.5).result == 0


def test_a_stream_finds_its_way_back(bed):
    client = bed.client("tcp")
    request = mav.MAVLink_command_long_message(1, 1, mav.MAV_CMD_REQUEST_MESSAGE, 0, 148, 0, 0, 0, 0, 0, 0)
    for wrong in (b"\x00garbage\xfe", struct.pack("<B", 0xFD) + bytes(30)):
        client.write(wrong)
        for _ in range(8):
            client.write(request.pack(client.mav))
        client.wait("COMMAND_ACK", 1.0)
        client.forget()


def test_only_what_is_signed_is_taken():
    with Bed("ardupilot", key=KEY) as bed:
        good, plain, wrong = bed.client("tcp", 245, KEY), bed.client("tcp", 246), bed.client("udp", 247, OTHER_KEY)
        assert good.command(mav.MAV_CMD_DO_SET_MODE, 1, 4) == 0
        assert good.all("COMMAND_ACK")[0].get_header().incompat_flags & mav.MAVLINK_IFLAG_SIGNED
        bed.advance(1.1)
        assert plain.command(mav.MAV_CMD_DO_SET_MODE, 1, 5) == mav.MAV_RESULT_DENIED
        bed.advance(0.2)
        assert any("Unsigned command refused" in "".join(client.texts()) for client in (plain, good))
        for client in (good, wrong):
            client.forget()
        wrong.mav.command_long_send(1, 1, mav.MAV_CMD_DO_SET_MODE, 0, 1, 5, 0, 0, 0, 0, 0)
        bed.advance(1.5)
        assert not wrong.all("COMMAND_ACK"), "as with either firmware"
        assert "".join(good.texts()) == "Wrong key or repeated signature, ignored: system 247"
        client = plain
        client.mav.param_set_send(1, 1, b"SIM_BAT_DRAIN", 50.0, mav.MAV_PARAM_TYPE_REAL32)
        bed.advance(2.0)
        assert next(p.value for p in bed.firmware.params() if p.name == "SIM_BAT_DRAIN") == 0.0
        assert bed.firmware.telemetry(bed.flight.now_s).custom_mode == 4


def test_nobody_without_the_key_shuts_its_owner_out():
    """A frame of the owner's ids, signed with another key and stamped with the far future."""
    with Bed("ardupilot", key=KEY) as bed:
        good, forger = bed.client("tcp", 245, KEY), bed.client("udp", 245, OTHER_KEY)
        forger.beats = False
        forger.mav.signing.link_id = good.mav.signing.link_id
        assert good.command(mav.MAV_CMD_DO_SET_MODE, 1, 4) == 0
        forger.mav.signing.timestamp += int(1e13)
        forger.mav.command_long_send(1, 1, mav.MAV_CMD_DO_SET_MODE, 0, 1, 5, 0, 0, 0, 0, 0)
        bed.advance(0.5)
        assert good.command(mav.MAV_CMD_DO_SET_MODE, 1, 5) == 0


def test_a_recorded_command_is_not_taken_twice():
    with Bed("ardupilot", key=KEY) as bed:
        good, thief = bed.client("tcp", 245, KEY), bed.client("udp", 246)
        bed.advance(0.1)
        frame = mav.MAVLink_command_long_message(1, 1, 176, 0, 1, 4, 0, 0, 0, 0, 0).pack(good.mav)
        good.write(frame)
        good.wait("COMMAND_ACK")
        assert good.command(176, 1, 5) == 0
        thief.write(frame)
        bed.advance(1.0)
        assert bed.firmware.telemetry(bed.flight.now_s).custom_mode == 5
