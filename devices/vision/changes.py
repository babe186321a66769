"""What changed before a camera, as a line for people."""

from devices.vision.tracking import Change
from wire.catalogue import catalogue
from wire.frames import distance_m

_WORDS = {
    "isOpen": ("opened", "closed"),
    "isToggled": ("turned on", "turned off"),
    "isDirty": ("got dirty", "is clean now"),
    "isSliced": ("was sliced", "is whole"),
}
NEAR_M = 1.5


def describe(change: Change, others: list[tuple[str, tuple[float, float, float]]]) -> str:
    """`Television turned on`, `Apple appeared near DiningTable`; `others` are the known things and their places."""
    track = change.track
    if change.what in _WORDS:
        return f"{track.type} {_WORDS[change.what][0 if change.value else 1]}"
    near = _landmark(track.type, track.position_enu_m, others)
    place = f" near {near}" if near else f" at {track.position_enu_m[0]:.1f}, {track.position_enu_m[1]:.1f}"
    return f"{track.type} appeared{place}" if change.what == "appeared" else f"{track.type}{place} is no longer there"


def _landmark(
    own_type: str, place: tuple[float, float, float], others: list[tuple[str, tuple[float, float, float]]]
) -> str | None:
    """The nearest piece of furniture."""
    rows = catalogue()
    furniture = [
        (distance_m(place, position), name)
        for name, position in others
        if name != own_type and name in rows and rows[name].kind != "pickup"
    ]
    nearest = min(furniture, default=None)
    return nearest[1] if nearest is not None and nearest[0] <= NEAR_M else None
