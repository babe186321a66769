"""What words of an instruction may name: types of things, by what people call them."""

import re
from collections.abc import Collection, Iterable
from functools import lru_cache

from wire.catalogue import catalogue, modelled_types
from wire.names import classes, names_of, plural

_WORD = re.compile(r"[^\W_]+")
LONGEST = 4


def known_types(present: Iterable[str]) -> tuple[str, ...]:
    """Types that can be spoken of: those that can be recognised, and those that are there."""
    return tuple(sorted({*modelled_types(), *(t for t in present if t in catalogue())}))


@lru_cache(maxsize=1)
def _phrases() -> dict[tuple[str, ...], frozenset[str]]:
    """Phrase in lower case -> the types that it may mean."""
    table: dict[tuple[str, ...], frozenset[str]] = {}
    for name in catalogue():
        for phrase in names_of(name):
            _add(table, phrase, {name})
    for phrase, types in classes().items():
        _add(table, phrase, set(types))
    return table


def _add(table: dict[tuple[str, ...], frozenset[str]], phrase: str, types: Collection[str]) -> None:
    for form in (phrase, plural(phrase)):
        key = tuple(form.split())
        table[key] = table.get(key, frozenset()) | frozenset(types)


def mentioned_types(text: str, among: Collection[str]) -> frozenset[str]:
    """Types of `among` that some words of a text may mean; a longer name hides the shorter ones in it."""
    words = [word.lower() for word in _WORD.findall(text)]
    found: set[str] = set()
    at = 0
    while at < len(words):
        size, types = _longest(words[at : at + LONGEST])
        found |= types
        at += size
    return frozenset(found & set(among))


def _longest(words: list[str]) -> tuple[int, frozenset[str]]:
    for size in range(len(words), 0, -1):
        types = _phrases().get(tuple(words[:size]))
        if types is not None:
            return size, types
    return 1, frozenset()
