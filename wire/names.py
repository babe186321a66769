"""What people call things and rooms, read from `names.toml`: whoever is asked in words understands the same ones."""

import re
import tomllib
from functools import lru_cache
from importlib.resources import files

_IRREGULAR_PLURALS = {"knife": "knives", "loaf": "loaves", "shelf": "shelves", "bus": "buses"}
_VOWELS = "aeiou"


@lru_cache(maxsize=1)
def _tables() -> dict[str, dict[str, tuple[str, ...]]]:
    return read_phrases(files("wire").joinpath("names.toml").read_text())


def read_phrases(toml: str) -> dict[str, dict[str, tuple[str, ...]]]:
    """Every table of such a file: row name -> phrases."""
    return {table: {row: _phrases(text) for row, text in rows.items()} for table, rows in tomllib.loads(toml).items()}


def _phrases(text: str) -> tuple[str, ...]:
    return tuple(part.strip() for part in text.split(",") if part.strip())


def names_of(type: str) -> tuple[str, ...]:
    """What a type is called in the singular, its own words last."""
    own = spaced(type)
    return (*(name for name in _tables()["name"].get(type, ()) if name != own), own)


def called(type: str) -> str:
    """What people call a type."""
    return _tables()["name"].get(type, (spaced(type),))[0]


def classes() -> dict[str, tuple[str, ...]]:
    """A word for several types -> these types."""
    return _tables()["class"]


def collectives() -> tuple[str, ...]:
    """Words of `classes` that mean all there is although they are singular."""
    return _tables()["collective"]["words"]


def room_names(kind: str) -> tuple[str, ...]:
    """What a kind of room is called."""
    return _tables()["room"].get(kind, ())


def plural(noun: str) -> str:
    """The plural of a noun phrase: its last word takes the ending ("bottle of wine": its first)."""
    words = noun.split()
    if "of" in words:
        head = words.index("of") - 1
        return " ".join((*words[:head], plural(words[head]), *words[head + 1 :]))
    *rest, last = words
    return " ".join((*rest, _plural_word(last)))


def _plural_word(word: str) -> str:
    if word in _IRREGULAR_PLURALS:
        return _IRREGULAR_PLURALS[word]
    if word.endswith(("s", "x", "ch", "sh", "to")):
        return word + "es"
    if word.endswith("y") and word[-2] not in _VOWELS:
        return word[:-1] + "ies"
    return word + "s"


def spaced(name: str) -> str:
    """ "coffee table" of "CoffeeTable"."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", name).lower()
