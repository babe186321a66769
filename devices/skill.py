"""A skill as a device announces it: name, docstring, the parameters it takes out of a command."""

import inspect
import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from pydantic import ValidationError

from wire.messages.command import Command
from wire.messages.plan import SkillCard
from wire.model import Message

Run = TypeVar("Run", bound=Callable[..., object])


@dataclass(frozen=True)
class Skill(Generic[Run]):
    """`run`'s docstring is what a planner reads; `parameters` are the fields of `Command` that it uses, and its own,
    which come in `Command.params`."""

    name: str
    parameters: type[Message]
    run: Run

    def card(self) -> SkillCard:
        schema = json.dumps(self.parameters.model_json_schema(), separators=(",", ":"), sort_keys=True)
        return SkillCard(name=self.name, doc=inspect.getdoc(self.run) or "", parameters=schema)

    def fault_of(self, command: Command) -> str:
        """Why the command's parameters do not suit, in a sentence; empty when they do."""
        fields = self.parameters.model_fields.keys() & Command.model_fields.keys()
        given = {name: value for name in fields if (value := getattr(command, name)) is not None}
        try:
            self.parameters.model_validate(given | command.params)
        except ValidationError as error:
            faults = "; ".join(f"{'.'.join(map(str, e['loc'])) or 'parameters'}: {e['msg']}" for e in error.errors())
            return f"{self.name}: {faults}"
        return ""
