"""The fixed part of the vocabulary, read from `vocabulary.toml`, with the forms of words that spelling derives."""

from functools import lru_cache
from importlib.resources import files

from wire.names import read_phrases

Phrase = tuple[str, ...]


@lru_cache(maxsize=1)
def tables() -> dict[str, dict[str, tuple[str, ...]]]:
    """Every table of the file: row name -> phrases."""
    return read_phrases(files("planners.scripted").joinpath("vocabulary.toml").read_text())


def gerund(verb: str) -> str:
    """ "closing" of "close", "turning off" of "turn off"."""
    first, *rest = verb.split()
    irregular = tables()["irregular"].get(first)
    if irregular:
        form = irregular[0]
    elif first.endswith("e") and not first.endswith("ee"):
        form = first[:-1] + "ing"
    else:
        form = first + "ing"
    return " ".join((form, *rest))


@lru_cache(maxsize=1)
def fixed_phrases() -> dict[Phrase, tuple[str, str]]:
    """Phrase -> (token type, base form) for verbs, small words, numbers and what is dropped."""
    table: dict[Phrase, tuple[str, str]] = {}
    for reason, words in tables()["limit"].items():
        table.update({tuple(w.split()): ("LIMIT", reason) for w in words})
    for reason, words in tables()["control"].items():
        table.update({tuple(w.split()): ("CONTROL", reason) for w in words})
    for word in tables()["reported"]["words"]:
        table[tuple(word.split())] = ("REPORTED", word)
    for word in tables()["no_room"]["words"]:
        table[tuple(word.split())] = ("NOROOM", word)
    for kind, verbs in tables()["verb"].items():
        for verb in verbs:
            table[tuple(verb.split())] = table[tuple(gerund(verb).split())] = (kind, verb)
    for kind, words in tables()["small"].items():
        table.update({tuple(w.split()): (kind, w) for w in words})
    for value, words in tables()["number"].items():
        table.update({tuple(w.split()): ("NUM", value) for w in words})
    table.update({tuple(w.split()): ("DROPPED", w) for w in tables()["dropped"]["anywhere"]})
    return table
