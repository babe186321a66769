"""Token types and adjectives as the states that they stand for."""

from planners.scripted.lexicon import Word
from planners.scripted.syntax import State

STATES: dict[str, State] = {
    "P_ON": "on",
    "ISON": "on",
    "SWITCH_ON": "on",
    "P_OFF": "off",
    "ISOFF": "off",
    "SWITCH_OFF": "off",
    "OPEN": "open",
    "ISOPEN": "open",
    "CLOSE": "closed",
    "ISCLOSED": "closed",
    "CLEAN": "clean",
    "ISCLEAN": "clean",
    "DIRTY": "dirty",
    "SLICE": "sliced",
    "ISSLICED": "sliced",
    "ALONE": "alone",
}


def adjective(word: Word) -> str:
    """The token type that an adjective had as a word of its own."""
    return {"open": "OPEN", "opened": "ISOPEN", "closed": "ISCLOSED", "dirty": "DIRTY", "unwashed": "DIRTY"}.get(
        word.text.lower(), "ISSLICED" if word.text.lower() in ("sliced", "chopped") else "CLEAN"
    )
