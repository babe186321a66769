"""The corpus `instructions.jsonl`: what people say in many styles, and what it must come out as in the fixed home.

Each line has what is said, its style, who can read it (`grammar`, or `model`: the grammar refuses it) and what is
wanted: goals in the notation of `test_corpus`, `!` for a refusal with a reason, `?` for a question to the operator.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from tests.planners.test_corpus import notation
from wire.messages.goal import Goal


@dataclass(frozen=True)
class Row:
    style: str
    by: str
    say: str
    want: str

    @property
    def refused(self) -> bool:
        return self.want in ("!", "?")


@lru_cache(maxsize=1)
def rows() -> tuple[Row, ...]:
    lines = Path(__file__).with_name("instructions.jsonl").read_text(encoding="utf-8").splitlines()
    return tuple(Row(**json.loads(line)) for line in lines)


def written(goals: Sequence[Goal]) -> str:
    """Goals in notation."""
    return " ; ".join(notation(goal) for goal in goals)
