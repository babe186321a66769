"""A skill as a device announces it: name, docstring, the parameters it takes out of a command."""

import inspect
import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from pydantic import ValidationError

from wire.messages.command import Command, SkillCard
from wire.model import Message

Run = TypeVar("Run", bound=Callable[..., object])


@dataclass(frozen=True)
class Skill(Generic[Run]):
    """`run`'s docstring is what a planner reads; `parameters` are the fields of `Command` that it uses."""

    name: str
    parameters: type[Message]
    run: Run

    def card(self) -> SkillCard:
        schema = json.dumps(self.parameters.model_json_schema(), separators=(",", ":"), sort_keys=True)
        return SkillCard(name=self.name, doc=inspect.getdoc(self.run) or "", parameters=schema)

    def fault_of(self, command: Command) -> str:
        """Why the command's parameters do not suit, in a sentence; empty when they do."""
        given = {name: getattr(command, name) for name in self.parameters.model_fields}
        try:
            self.parameters.model_validate({name: value for name, value in given.items() if value is not None})
        except ValidationError as error:
            faults = "; ".join(f"{'.'.join(map(str, e['loc'])) or 'parameters'}: {e['msg']}" for e in error.errors())
            return f"{self.name}: {faults}"
        return ""
