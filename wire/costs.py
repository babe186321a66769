"""What a task has cost a language model, in words: the same on a terminal and in the view."""

from wire.messages.operator import TaskState

STAND_IN = "from a stand-in, not a model"


def planner_text(state: TaskState) -> str:
    """Who made the plan; where that was not the chosen planner, why."""
    note = f" ({state.planner_note})" if state.planner_note else ""
    return f"planner {state.planner or '-'}{note}"


def cost_text(state: TaskState) -> str:
    """Tokens and calls; empty where no model was asked."""
    if not state.model_calls and not state.prompt_tokens and not state.completion_tokens:
        return ""
    calls = f" in {state.model_calls} call{'s' if state.model_calls != 1 else ''}" if state.model_calls else ""
    tokens = f"{state.prompt_tokens} + {state.completion_tokens} tokens{calls}"
    return f"{tokens} {STAND_IN}" if state.stand_in else tokens
