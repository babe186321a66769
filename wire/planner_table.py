"""The table `[planner]` of the site file: who plans, with which model, and what that may cost."""

from typing import Annotated, Literal

from pydantic import Field

from wire.model import Message, Word

MODELLESS_S = 60.0
"""How long a plan that no model has a part in may take."""
_ROUND_S = 30.0
"""For what a planner does besides: waiting between tries, and planning without the model in the end."""

ModelName = Annotated[
    str,
    Field(
        pattern=r"^[A-Za-z0-9][A-Za-z0-9._/-]{0,127}(:[A-Za-z0-9][A-Za-z0-9._-]{0,127})?$",
        description="a model as `ollama list` names it, such as qwen3:8b",
    ),
]
Host = Annotated[
    str,
    Field(
        pattern=r"^$|^(https?://)?(\[[0-9A-Fa-f:]+\]|[A-Za-z0-9_.-]+)(:\d{1,5})?(/[^\s]*)?$",
        description="an address such as http://127.0.0.1:11434, or nothing for OLLAMA_HOST",
    ),
]


class Budget(Message):
    """What one task may cost. When it is spent, the model is not asked again for this task."""

    tokens: int = Field(default=30_000, ge=0)
    """Of prompts and answers together."""
    calls: int = Field(default=24, ge=0)
    """Tries that were repeated count each."""
    seconds: float = Field(default=300.0, ge=0.0, le=3600.0)
    """That the model has been waited for."""


class PlannerChoice(Message):
    """`name` is a row of `planners.planner.PLANNERS`. All else is for the rows that have a model."""

    name: Word = "scripted"
    model: ModelName = "qwen3:8b"
    vision: ModelName | Literal[""] = ""
    """The model that looks at pictures for cameras, such as qwen2.5vl:7b; empty for none. It may be the same one."""
    host: Host = ""
    """The model server; empty for the one that the environment names (`OLLAMA_HOST`), else this machine's."""
    num_ctx: int = Field(default=8192, ge=512, le=1_048_576)
    """Length of the context in tokens. The same for every call: a server loads the model anew when it changes."""
    timeout_s: float = Field(default=90.0, gt=0.0, le=1800.0)
    """For one call. On a machine without a graphics processor a model of 8 billion parameters needs most of it."""
    load_timeout_s: float = Field(default=300.0, gt=0.0, le=3600.0)
    """For loading the model, which begins when the planner starts."""
    seed: int = Field(default=0, ge=0, le=2**31 - 1)
    replies: Literal["off", "keep", "only"] = "off"
    """`keep`: an answer that was given before to the same question is given again, others are kept. `only`: nothing but
    kept answers, no server. They lie in the folder `replies` of the site's state."""
    grammar: bool = True
    """`goals` has the grammar read first. Without it the model reads everything, to compare models."""
    fallback: bool = True
    """Where the model fails, `scripted` plans. Without it the task is refused with the reason, as experiments want."""
    budget: Budget = Budget()

    @property
    def longest_s(self) -> float:
        """How long a plan may take by the wall clock: the budget may run out in the middle of a call."""
        if self.name == "scripted":
            return MODELLESS_S
        asking_s = self.budget.seconds + self.timeout_s
        # Every question may have to wait until a picture has been looked at.
        return (2.0 if self.vision else 1.0) * asking_s + _ROUND_S + MODELLESS_S
