"""The address of an autopilot: which there are, and what is wrong with one."""

import re

FORMS = "udpin://127.0.0.1:14540, udpout://HOST:PORT, tcpout://HOST:PORT or serial:///dev/ttyUSB0:57600"
_NET = re.compile(r"(?:udpin|udpout|tcpout)://(?P<host>[A-Za-z0-9_.-]+|\[[0-9A-Fa-f:.]+\]):(?P<port>\d{1,5})")
_SERIAL = re.compile(r"serial://(?P<device>/?[^:\s]+):(?P<baud>\d{1,8})")


def link_fault(robot: str, kind: str, link: str | None) -> str:
    """What is wrong with the `link` of a robot's row in the site file; empty when nothing is."""
    if link is None:
        return f"is missing: where {robot}'s autopilot is, such as {FORMS}" if kind == "drone" else ""
    if kind == "quadruped":
        return f"{robot} is a quadruped, which has no autopilot; leave it out, or set its kind to drone"
    return address_fault(link)


def address_fault(url: str) -> str:
    """Why this is no address of an autopilot; empty when it is one."""
    if found := _NET.fullmatch(url):
        port = int(found["port"])
        return "" if 0 < port < 65536 else f"{port} is no port; give 1 to 65535"
    if found := _SERIAL.fullmatch(url):
        return "" if int(found["baud"]) > 0 else "0 is no baud rate; autopilots use 57600, 115200 or 921600"
    scheme, separator, _ = url.partition("://")
    if separator and scheme in ("udpin", "udpout", "tcpout"):
        return f"{url} lacks a host or a port; write {scheme}://HOST:PORT"
    if separator and scheme == "serial":
        return f"{url} lacks a device or a baud rate; write serial:///dev/ttyUSB0:57600"
    return f"{url} is no address of an autopilot; write {FORMS}"
