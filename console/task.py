"""One instruction from the terminal: hand it over, show how it goes, say how it ended."""

import uuid
from typing import Any

from console.client import Client
from console.output import checked, terminal
from wire.costs import cost_text, planner_text
from wire.messages.operator import ControlReply, ControlRequest, TaskQuery, TaskRequest, TaskState

HUB_BACK_TRIES = 30
"""A hub that is restarted in the middle of a task is waited for."""
_HALT_S = 30.0
"""How long a cancelled task may take to come to rest."""
RUNNING = ("planning", "running", "paused")


def run_task(client: Client, instruction: str, limit_s: float, quiet: bool) -> TaskState:
    """Start the task and wait for its end. Ctrl-C cancels it and the robots stop; returns the last state."""
    task = f"task-{uuid.uuid4().hex[:8]}"
    request = checked(TaskRequest, task=task, instruction=instruction)
    client.listen("task_state", task)
    state = client.ask("task", request, TaskState)
    shown: list[str] = []
    if not quiet:
        terminal.print(f"{task} (Ctrl-C or `justw cancel {task}` ends it)", markup=False)
    try:
        for update in client.messages(TaskState, limit_s, first=state, poll=_poll(client, task)):
            state = update
            if not quiet:
                _show(state, shown)
            if state.status not in RUNNING:
                break
    except KeyboardInterrupt:
        state = _cancel(client, task)
    return state


def _cancel(client: Client, task: str) -> TaskState:
    """Cancel, and wait until the robots stand still."""
    client.ask("control", ControlRequest(verb="cancel", task=task), ControlReply)
    poll = _poll(client, task)
    state: TaskState = poll()
    for update in client.messages(TaskState, _HALT_S, first=state, poll=poll):
        state = update
        if state.status not in RUNNING:
            break
    return state


def _poll(client: Client, task: str) -> Any:
    """Asks for the state when nothing came for a while: the publication may have been missed while reconnecting."""
    return lambda: client.ask("task_query", TaskQuery(task=task), TaskState, tries=HUB_BACK_TRIES)


def _show(state: TaskState, shown: list[str]) -> None:
    """Print the lines of the task's log that have not been printed yet."""
    for line in state.log:
        if line not in shown:
            shown.append(line)
            terminal.print(f"{line}", markup=False)


def task_document(state: TaskState) -> dict[str, Any]:
    return {"ok": state.status == "done", **state.model_dump(mode="json")}


def task_text(state: TaskState) -> str:
    cost = cost_text(state)
    if state.refusal is not None:
        named = not state.refusal.part or f"'{state.refusal.part}'" in state.refusal.reason
        part = "" if named else f" ('{state.refusal.part}')"
        return "\n".join(filter(None, (f"not done: {state.refusal.reason}{part}", state.planner_note, cost)))
    if state.status in RUNNING:
        goes_on = f"{state.task} goes on; `justw cancel {state.task}` ends it"
        return f"{state.status}: {state.reason or state.instruction}\n{goes_on}"
    goals = "".join(f"  {'yes' if g.holds else 'no ':<4}{g.goal.text or g.goal.predicate}\n" for g in state.goals)
    return (
        f"{state.status}: {state.reason or state.instruction}\n{goals}"
        f"{planner_text(state)}, {state.nodes_done} of {state.nodes_total} steps, {state.replans} replans, "
        f"{state.action_steps} action steps, {state.path_m:.1f} m{f', {cost}' if cost else ''}"
    )
