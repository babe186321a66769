"""The fixed part of the vocabulary, read from `vocabulary.toml`, with the forms of words that spelling derives."""

import tomllib
from functools import lru_cache
from importlib.resources import files

Phrase = tuple[str, ...]
VOWELS = "aeiou"
IRREGULAR_PLURALS = {"knife": "knives", "loaf": "loaves", "shelf": "shelves", "bus": "buses"}


@lru_cache(maxsize=1)
def tables() -> dict[str, dict[str, tuple[str, ...]]]:
    """Every table of the file: row name -> phrases."""
    data = tomllib.loads(files("planners.scripted").joinpath("vocabulary.toml").read_text())
    return {table: {row: _phrases(text) for row, text in rows.items()} for table, rows in data.items()}


def _phrases(text: str) -> tuple[str, ...]:
    return tuple(part.strip() for part in text.split(",") if part.strip())


def plural(noun: str) -> str:
    """The plural of a noun phrase: its last word takes the ending ("bottle of wine": its first)."""
    words = noun.split()
    if "of" in words:
        head = words.index("of") - 1
        return " ".join((*words[:head], plural(words[head]), *words[head + 1 :]))
    *rest, last = words
    return " ".join((*rest, _plural_word(last)))


def _plural_word(word: str) -> str:
    if word in IRREGULAR_PLURALS:
        return IRREGULAR_PLURALS[word]
    if word.endswith(("s", "x", "ch", "sh", "to")):
        return word + "es"
    if word.endswith("y") and word[-2] not in VOWELS:
        return word[:-1] + "ies"
    return word + "s"


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
