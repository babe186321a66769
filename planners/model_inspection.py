"""What a model server has and gives, for people who set one up: no model is asked anything here."""

import asyncio
from dataclasses import dataclass

from planners.model import KEEP_ALIVE, SERVER_FAULTS, Facts, address, allocated, client, describe, facts_of
from planners.reply_checks import Fault
from wire.planner_table import PlannerChoice

_LIMIT_S = 5.0


@dataclass(frozen=True)
class ServerState:
    """As of now. `fault` says what there is instead of what follows it."""

    host: str
    answers: bool = False
    fault: Fault | None = None
    pulled: tuple[str, ...] = ()
    """Names of the models that are there."""
    facts: Facts | None = None
    context: int | None = None
    """Tokens that the loaded model really has; None while it is not loaded."""


def inspect(choice: PlannerChoice, load: bool = False) -> ServerState:
    """Look at the server of the site file, and at its model; with `load`, once that is loaded as the planner wants it."""
    return asyncio.run(_inspect(choice, choice.load_timeout_s if load else _LIMIT_S, load))


async def _inspect(choice: PlannerChoice, limit_s: float, load: bool) -> ServerState:
    host = address(choice.host)
    pulled: tuple[str, ...] | None = None
    try:
        async with asyncio.timeout(limit_s), client(choice.host, limit_s) as server:
            pulled = tuple(str(row.model) for row in (await server.list()).models)
            facts = facts_of(await server.show(choice.model))
            if load:
                await server.chat(choice.model, [], options={"num_ctx": choice.num_ctx}, keep_alive=KEEP_ALIVE)
            context = allocated(await server.ps(), choice.model)
    except SERVER_FAULTS as error:
        return ServerState(host, pulled is not None, describe(error, choice, limit_s), pulled or ())
    return ServerState(host, True, None, pulled, facts, context)
