"""Names and ids to key expressions, and back: an id is checked before it becomes part of a key."""

import re
from functools import lru_cache

from wire.keys import SERVICE, TOPIC, Role, Service, Topic

_ID = re.compile(r"[a-z0-9][a-z0-9-]{0,31}")
PLACE = "{id}"


@lru_cache(maxsize=4096)
def key(realm: str, path: str, id: str) -> str:
    """The key `<realm>/<path>` for one device; ValueError for an id that is none, or that the path has no place for."""
    if (PLACE in path) != bool(id):
        raise ValueError(f"{path}: {'an id is needed' if PLACE in path else f'takes no id, {id!r} was given'}")
    if id and not _ID.fullmatch(id):
        raise ValueError(f"{id!r} is no id: lower-case letters, digits and hyphens, at most 32")
    return f"{realm}/{path.replace(PLACE, id)}"


def pattern(realm: str, path: str, id: str | None) -> str:
    """The key expression of one device, or of all when `id` is None."""
    if id is None and PLACE in path:
        return f"{realm}/{path.replace(PLACE, '*')}"
    return key(realm, path, id or "")


def id_in(realm: str, path: str, full_key: str) -> str | None:
    """The `{id}` of a key that a pattern matched; None when the key is not one that `key` would build."""
    before, _, after = f"{realm}/{path}".partition(PLACE)
    if PLACE not in path:
        return "" if full_key == before else None
    id = full_key[len(before) : len(full_key) - len(after)]
    fits = full_key.startswith(before) and full_key.endswith(after)
    return id if fits and _ID.fullmatch(id) else None


def topic_for(name: str, role: Role, *, publishing: bool) -> Topic:
    """The topic's row. What the table does not grant to the role fails here, and not silently at the router."""
    topic = TOPIC[name]
    if role not in (topic.publishers if publishing else topic.subscribers):
        verb = "publish" if publishing else "subscribe to"
        raise PermissionError(f"role {role} may not {verb} {name}; wire.keys lists who may")
    return topic


def service_for(name: str, role: Role, *, serving: bool) -> Service:
    service = SERVICE[name]
    if role not in (service.servers if serving else service.callers):
        raise PermissionError(f"role {role} may not {'serve' if serving else 'call'} {name}; wire.keys lists who may")
    return service
