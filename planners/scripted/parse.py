"""Tokens to a tree: the grammar of `grammar.lark`, and refusals that name the words it cannot place."""

from collections.abc import Iterator, Sequence
from functools import lru_cache
from importlib.resources import files
from typing import Any

from lark import Lark, Token, UnexpectedInput
from lark.lexer import Lexer

from planners.scripted.lexicon import Lexicon, Word
from planners.scripted.strangers import refuse_strangers
from planners.scripted.syntax import Item, Unclear
from planners.scripted.tokens import tokens
from planners.scripted.tree import Builder


class _TypedWords(Lexer):
    """The words come typed; lark's own lexer has nothing to do."""

    def __init__(self, lexer_conf: Any) -> None:
        pass

    def lex(self, data: Any) -> Iterator[Token]:  # type: ignore[override]  # a lexer of lark's older interface
        for word in data:
            yield Token(word.kind, word, start_pos=word.start, end_pos=word.end)


@lru_cache(maxsize=1)
def grammar() -> Lark:
    text = files("planners.scripted").joinpath("grammar.lark").read_text()
    return Lark(text, parser="lalr", lexer=_TypedWords, strict=True, propagate_positions=True)


def parse(instruction: str, lexicon: Lexicon) -> tuple[Item, ...]:
    """The clauses of an instruction. Raises Unclear unless every word has been placed."""
    words = lexicon.words(instruction)
    refuse_strangers(words, instruction)
    typed = tokens(words)
    if not typed:
        raise Unclear("there is nothing to do in it", instruction.strip(), final=True)
    try:
        tree = grammar().parse(typed)
    except UnexpectedInput as error:
        raise _misplaced(error, typed, instruction) from None
    items: tuple[Item, ...] = Builder(instruction).transform(tree)
    return items


def _misplaced(error: UnexpectedInput, typed: Sequence[Word], instruction: str) -> Unclear:
    token = getattr(error, "token", None)
    if token is None or token.type == "$END":
        part = instruction[typed[-1].start : typed[-1].end]
        return Unclear(f"the instruction stops too early, after '{part}'", part)
    word: Word = token.value
    before = next((w for w in reversed(typed) if w.start < word.start), None)
    if word.kind.startswith("SEP") or word.kind.endswith("AND"):
        left = before or word
        return Unclear(f"something is missing after '{left.text}'", left.text)
    end = next((w.start for w in typed if w.start > word.start and w.kind.startswith("SEP")), typed[-1].end)
    part = instruction[word.start : max(end, word.end)].strip()
    if word.kind == "NUM" and before is not None and before.kind == "NOUN":
        name = f"{before.text} {word.text}"
        return Unclear(
            f"nothing here is called '{name}': say the room that the {before.text} is in, or its id", name, final=True
        )
    if word.kind == "IS":
        start = next((w.end for w in reversed(typed) if w.end <= word.start and w.kind.startswith("SEP")), 0)
        said = instruction[start : word.end].strip()
        return Unclear(f"'{said} ...' only says how things are: say 'make sure that ...'", part, final=True)
    if word.kind == "OR":
        return Unclear("say which of them is meant: 'or' leaves it open", part, question=True)
    return Unclear(f"I do not understand '{part}' at this place", part)
