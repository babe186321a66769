"""Who may say and read what, generated from the tables of `wire.keys`: the router denies everything else.

Subjects are user names with passwords: one for each process of the site, and `console`, `evaluator` and `recorder`.
A camera's or robot's process is confined to its own ids, so that no camera speaks for another.
"""

import os
import secrets
from pathlib import Path
from typing import Any, NamedTuple

from wire.keys import PRESENCE_PATH, ROLES, SERVICES, TOPICS, Role
from wire.paths import PLACE, pattern
from wire.site import Process, Site

GUESTS: dict[str, Role] = {"console": "console", "evaluator": "evaluator", "recorder": "view"}
"""Users that are no rows of the process table."""
DICTIONARY = "users.txt"
CONFINED: frozenset[Role] = frozenset(("cctv", "robot"))
OWN_PATHS = frozenset(("clock/done/{id}", "health/{id}"))
"""Keys whose id is the speaking process, not a device: only it may say them, whoever may hear one may hear all."""


class User(NamedTuple):
    name: str
    role: Role
    devices: tuple[str, ...]
    """The ids it may speak and listen for; empty for all."""


def users_of(site: Site) -> list[User]:
    """Everybody who may enter this site's mesh, apart from the router."""
    rows = [User(p.id, p.role, devices_of(p)) for p in site.process if p.role in ROLES]
    return rows + [User(name, role, ()) for name, role in GUESTS.items() if all(r.name != name for r in rows)]


def devices_of(process: Process) -> tuple[str, ...]:
    """The devices that a process serves: itself, and for `cctv-3` also the camera `cam-3`."""
    if process.role not in CONFINED:
        return ()
    named = [arg for arg in process.args if arg.startswith("cam-")]
    camera = [f"cam-{process.id.removeprefix('cctv-')}"] if process.role == "cctv" and not named else named
    return (process.id, *camera)


def write_credentials(site: Site, folder: Path) -> Path:
    """A password for each user that has none yet, in a file each; returns the dictionary for the router."""
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    lines = []
    for user in users_of(site):
        file = folder / user.name
        if not file.exists():
            _write_secret(file, secrets.token_urlsafe(24))
        lines.append(f"{user.name}:{file.read_text().strip()}\n")
    dictionary = folder / DICTIONARY
    _write_secret(dictionary, "".join(lines))
    return dictionary


def _write_secret(file: Path, text: str) -> None:
    part = file.with_name(f".{file.name}.{os.getpid()}")
    part.touch(mode=0o600)
    part.write_text(text)
    part.replace(file)


def access_control(site: Site) -> dict[str, Any]:
    """Zenoh's `access_control` block for the router of this site."""
    rules, subjects, policies = [], [], []
    everything = [f"{site.realm}/**"]
    # whoever publishes must be told of subscribers, and whoever asks of servers: harmless to anybody with a password
    rules.append(_rule("told", "egress", ["declare_subscriber", "declare_queryable"], everything))
    for user in users_of(site):
        own = [_rule(f"{user.name}-{name}", flow, messages, keys) for name, flow, messages, keys in _grants(site, user)]
        own = [rule for rule in own if rule["key_exprs"]]
        rules += own
        subjects.append({"id": user.name, "usernames": [user.name]})
        policies.append({"rules": ["told", *(rule["id"] for rule in own)], "subjects": [user.name]})
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": rules,
        "subjects": subjects,
        "policies": policies,
    }


def _grants(site: Site, user: User) -> list[tuple[str, str, list[str], list[str]]]:
    """(name, flow, Zenoh's message kinds, keys) of everything one user may do."""
    says = _keys(site, user, [t.path for t in TOPICS if user.role in t.publishers], speaking=True)
    hears = _keys(site, user, [t.path for t in TOPICS if user.role in t.subscribers])
    serves = _keys(site, user, [s.path for s in SERVICES if user.role in s.servers])
    asks = _keys(site, user, [s.path for s in SERVICES if user.role in s.callers])
    everyone_alive = [pattern(site.realm, PRESENCE_PATH, None)]
    return [
        ("says", "ingress", ["put"], says),
        ("hears-in", "ingress", ["declare_subscriber"], hears),
        ("hears-out", "egress", ["put"], hears),
        ("serves-in", "ingress", ["declare_queryable", "reply"], serves),
        ("serves-out", "egress", ["query"], serves),
        ("asks-in", "ingress", ["query"], asks),
        ("asks-out", "egress", ["reply"], asks),
        ("lives", "ingress", ["liveliness_token"], [_own(site, user, PRESENCE_PATH)]),
        ("watches-in", "ingress", ["declare_liveliness_subscriber", "liveliness_query"], everyone_alive),
        ("watches-out", "egress", ["liveliness_token"], everyone_alive),
    ]


def _keys(site: Site, user: User, paths: list[str], speaking: bool = False) -> list[str]:
    keys: set[str] = set()
    for path in paths:
        if speaking and path in OWN_PATHS:
            keys.add(_own(site, user, path))
        elif PLACE in path and user.devices and path not in OWN_PATHS:
            keys |= {pattern(site.realm, path, device) for device in user.devices}
        else:
            keys.add(pattern(site.realm, path, None))
    return sorted(keys)


def _own(site: Site, user: User, path: str) -> str:
    # every console has an id of its own under the one user, `console` or `console-<something>`
    return f"{site.realm}/{path.replace(PLACE, f'{user.name}$*' if user.name in GUESTS else user.name)}"


def _rule(id: str, flow: str, messages: list[str], keys: list[str]) -> dict[str, Any]:
    return {"id": id, "permission": "allow", "flows": [flow], "messages": messages, "key_exprs": keys}
