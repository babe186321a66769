"""Sockets that never block: UDP to an address, UDP from anybody, and a TCP server with several clients."""

import errno
import ipaddress
import logging
import socket
from collections.abc import Iterator
from itertools import count
from typing import Protocol

from sim.mavlink.peer import Message, Peer, Signing

log = logging.getLogger(__name__)
MAX_DATAGRAMS = 512
"""Taken from one socket per poll, so that a flood cannot keep the vehicle from being stepped."""
MAX_PEERS = 16
FORGET_S = 15.0
"""A client of the UDP server that says nothing for so long gets no more telemetry."""
SILENT_S = 3.0
"""A TCP client that says nothing for so long, where all send heartbeats each second, makes room for a new one."""
SLOW_BYTES = 64 * 1024
GONE_BYTES = 1024 * 1024
_ids = count(1)

Heard = tuple[Peer, Message]


class LinkError(Exception):
    """A link cannot be opened: says which, why, and what to do."""


class LeavesMachine(LinkError):
    """The far end of a link is elsewhere, and this one is bound to the loopback."""


class Link(Protocol):
    """One socket and its peers."""

    def files(self) -> list[socket.socket]:
        """What to wait on for input."""
        ...

    def peers(self) -> list[Peer]: ...

    def poll(self, now_s: float) -> Iterator[Heard]: ...

    def close(self) -> None: ...


def _bound(kind: socket.SocketKind, address: str, port: int) -> socket.socket:
    name = {socket.SOCK_DGRAM: "UDP", socket.SOCK_STREAM: "TCP"}[kind]
    made = socket.socket(socket.AF_INET, kind)
    made.setblocking(False)
    if kind is socket.SOCK_STREAM:
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        made.bind((address, port))
        if kind is socket.SOCK_STREAM:
            made.listen(MAX_PEERS)
    except OSError as error:
        made.close()
        if error.errno == errno.EADDRINUSE:
            raise LinkError(f"{name} port {port} is in use: stop what uses it or choose another") from error
        raise LinkError(f"{name} {address}:{port} cannot be opened: {error.strerror}") from error
    return made


def _receive(made: socket.socket) -> Iterator[tuple[bytes, tuple[str, int]]]:
    for _ in range(MAX_DATAGRAMS):
        try:
            yield made.recvfrom(4096)
        except BlockingIOError:
            return
        except ConnectionError:
            continue


class UdpOut:
    """Sends to one address from the start, and takes what comes back from that host."""

    def __init__(self, host: str, port: int, bind: str = "127.0.0.1", signing: Signing | None = None) -> None:
        """Raises LinkError when the host is unknown or cannot be reached from the address bound to."""
        try:
            self._to = (socket.gethostbyname(host), port)
        except OSError as error:
            raise LinkError(f"UDP to {host}:{port}: no such host") from error
        if ipaddress.ip_address(bind).is_loopback and not ipaddress.ip_address(self._to[0]).is_loopback:
            raise LeavesMachine(f"UDP to {host}:{port} leaves this machine, but links bind to {bind}")
        self._socket = _bound(socket.SOCK_DGRAM, bind, 0)
        self._peer = Peer(f"udp to {host}:{port}", self._write, next(_ids) & 0xFF, signing)

    def _write(self, frame: bytes, urgent: bool) -> bool:
        del urgent
        return _send_to(self._socket, frame, self._to)

    def files(self) -> list[socket.socket]:
        return [self._socket]

    def peers(self) -> list[Peer]:
        return [self._peer]

    def poll(self, now_s: float) -> Iterator[Heard]:
        del now_s
        for data, address in _receive(self._socket):
            if address[0] == self._to[0]:
                for message in self._peer.datagram(data):
                    yield self._peer, message

    def close(self) -> None:
        self._socket.close()


class UdpIn:
    """Waits on a port; whoever has sent a whole message is sent everything until it falls silent."""

    def __init__(self, port: int, bind: str = "127.0.0.1", signing: Signing | None = None) -> None:
        """Raises LinkError when the port is taken."""
        self._socket = _bound(socket.SOCK_DGRAM, bind, port)
        self._signing = signing
        self._peers: dict[tuple[str, int], tuple[Peer, float]] = {}
        self.port: int = self._socket.getsockname()[1]

    def files(self) -> list[socket.socket]:
        return [self._socket]

    def peers(self) -> list[Peer]:
        return [peer for peer, _ in self._peers.values()]

    def _new(self, address: tuple[str, int]) -> Peer:
        made = self._socket

        def write(frame: bytes, urgent: bool) -> bool:
            del urgent
            return _send_to(made, frame, address)

        return Peer(f"udp from {address[0]}:{address[1]}", write, next(_ids) & 0xFF, self._signing)

    def poll(self, now_s: float) -> Iterator[Heard]:
        for data, address in _receive(self._socket):
            known = self._peers.get(address)
            peer = known[0] if known else self._new(address)
            messages = peer.datagram(data)
            if messages and (known or len(self._peers) < MAX_PEERS):
                self._peers[address] = (peer, now_s)
                for message in messages:
                    yield peer, message
        for address in [at for at, (_, heard_s) in self._peers.items() if now_s - heard_s > FORGET_S]:
            del self._peers[address]

    def close(self) -> None:
        self._socket.close()


class TcpServer:
    """Takes clients as they come; one that stops reading loses telemetry first and then its connection.

    Who only listens may stay, until all places are taken and somebody new comes: then the longest silent goes.
    """

    def __init__(self, port: int, bind: str = "127.0.0.1", signing: Signing | None = None) -> None:
        """Raises LinkError when the port is taken."""
        self._socket = _bound(socket.SOCK_STREAM, bind, port)
        self._signing = signing
        self._clients: list[_Client] = []
        self.port: int = self._socket.getsockname()[1]

    def files(self) -> list[socket.socket]:
        return [self._socket, *(client.socket for client in self._clients)]

    def peers(self) -> list[Peer]:
        return [client.peer for client in self._clients]

    def _make_room(self, now_s: float) -> None:
        """Let the longest silent client go, if it is silent enough."""
        client = min(self._clients, key=lambda each: each.heard_s)
        if now_s - client.heard_s >= SILENT_S:
            log.info("%s makes room: silent for %.0f s", client.peer.name, now_s - client.heard_s)
            client.socket.close()
            self._clients.remove(client)

    def _accept(self, now_s: float) -> None:
        for _ in range(MAX_PEERS):
            try:
                made, address = self._socket.accept()
            except (BlockingIOError, ConnectionError):
                return
            if len(self._clients) >= MAX_PEERS:
                self._make_room(now_s)
            if len(self._clients) >= MAX_PEERS:
                made.close()
                continue
            made.setblocking(False)
            made.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            made.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, GONE_BYTES // 8)
            self._clients.append(_Client(made, f"tcp from {address[0]}:{address[1]}", self._signing, now_s))

    def poll(self, now_s: float) -> Iterator[Heard]:
        self._accept(now_s)
        for client in self._clients:
            yield from client.poll(now_s)
        for client in [each for each in self._clients if each.gone]:
            client.socket.close()
            self._clients.remove(client)

    def close(self) -> None:
        for client in self._clients:
            client.socket.close()
        self._socket.close()


class _Client:
    def __init__(self, made: socket.socket, name: str, signing: Signing | None, now_s: float) -> None:
        self.socket = made
        self.heard_s = now_s
        """When it said a whole message last, or came."""
        self.gone = False
        self._waiting = bytearray()
        self.peer = Peer(name, self._write, next(_ids) & 0xFF, signing)

    def _write(self, frame: bytes, urgent: bool) -> bool:
        if self.gone or (len(self._waiting) > SLOW_BYTES and not urgent):
            return False
        self._waiting += frame
        self._flush()
        self.gone |= len(self._waiting) > GONE_BYTES
        return True

    def _flush(self) -> None:
        try:
            while self._waiting:
                del self._waiting[: self.socket.send(self._waiting)]
        except BlockingIOError:
            return
        except OSError:
            self.gone = True

    def poll(self, now_s: float) -> Iterator[Heard]:
        self._flush()
        for _ in range(MAX_DATAGRAMS // 8):
            if self.gone:
                return
            try:
                data = self.socket.recv(8192)
            except BlockingIOError:
                return
            except OSError:
                data = b""
            self.gone |= not data
            for message in self.peer.stream(data) if data else ():
                self.heard_s = now_s
                yield self.peer, message


def _send_to(made: socket.socket, frame: bytes, address: tuple[str, int]) -> bool:
    try:
        made.sendto(frame, address)
    except OSError:
        return False
    return True
