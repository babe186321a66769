"""The row of a planner that has a model: a budget for each task, a record of every call, and `scripted` where it fails."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from planners.asking import Model, ModelFailed
from planners.meter import Meter
from planners.opening import model_of
from planners.retries import RetryingModel
from planners.scripted.planner import NAME as SCRIPTED
from planners.scripted.planner import ScriptedPlanner
from wire.messages.plan import ModelCall, Plan, PlanReply, PlanRequest, Refusal
from wire.site import Site

if TYPE_CHECKING:
    from planners.planner import Planner

REJECTED = 2
"""After so many plans in a row that could not be carried out the model has had its chance."""
_TASKS = 64


class Modelled:
    """See planners.planner.Planner. What `planner` raises as ModelFailed ends here."""

    def __init__(self, site: Site, planner: "Planner", meter: Meter) -> None:
        self._planner, self._meter = planner, meter
        self._scripted = ScriptedPlanner(site)
        self._choice = site.planner
        self._given_up: dict[str, str] = {}
        """Task -> why the model is not asked for it any more."""

    def make_plan(self, request: PlanRequest) -> PlanReply:
        self._meter.open(request.task)
        judged: tuple[ModelCall, ...] = ()
        why = self._why_not(request)
        if not why:
            try:
                reply = self._planner.make_plan(request)
                judged = reply.calls
            except ModelFailed as failure:
                judged, why = (failure.call, *failure.rejects), str(failure)
                self._give_up(request.task, why)
        note = f"{SCRIPTED} instead of {self._choice.name}: {why}" if why and self._choice.fallback else ""
        if why:
            reply = self._without_model(request, why)
        return counted(reply, _with_verdicts(self._meter.calls(), judged), note)

    def _why_not(self, request: PlanRequest) -> str:
        """Why the model is not asked: it has failed at this task before. Empty where it is."""
        if not self._choice.fallback:
            return ""
        if request.rejected >= REJECTED:
            self._give_up(request.task, f"{request.rejected} plans in a row could not be carried out")
        return self._given_up.get(request.task, "")

    def _give_up(self, task: str, why: str) -> None:
        self._given_up.setdefault(task, why)
        while len(self._given_up) > _TASKS:
            del self._given_up[next(iter(self._given_up))]

    def _without_model(self, request: PlanRequest, why: str) -> PlanReply:
        if self._choice.fallback:
            return self._scripted.make_plan(request)
        return PlanReply(task=request.task, epoch=request.epoch, refusal=Refusal(reason=why[:2000]))


@dataclass(frozen=True)
class Row:
    """A row of PLANNERS whose planner has a model. See `modelled`."""

    make: Callable[[Site, Model], "Planner"]
    open_model: Callable[[Site], Model] | None
    sleep: Callable[[float], None]

    def __call__(self, site: Site) -> "Planner":
        meter = Meter((self.open_model or model_of)(site), site.planner.budget, site.planner.seed)
        return Modelled(site, self.make(site, RetryingModel(meter, self.sleep)), meter)


def modelled(
    make: Callable[[Site, Model], "Planner"],
    open_model: Callable[[Site], Model] | None = None,
    sleep: Callable[[float], None] = time.sleep,
) -> Callable[[Site], "Planner"]:
    """The row: `make` is handed the site and a model that counts, tries again, and raises ModelFailed.

    `open_model` opens another model than the site file's, for tests.
    """
    return Row(make, open_model, sleep)


def has_model(row: Callable[[Site], "Planner"]) -> bool:
    """Whether a row of the table asks a model."""
    return isinstance(row, Row)


def counted(reply: PlanReply, calls: tuple[ModelCall, ...], note: str) -> PlanReply:
    """The reply with every call in it, and their tokens in the plan."""
    plan: Plan | None = reply.plan
    if plan is not None:
        tokens = {
            "prompt_tokens": sum(call.prompt_tokens for call in calls),
            "completion_tokens": sum(call.completion_tokens for call in calls),
        }
        plan = plan.model_copy(update=tokens)
    return reply.model_copy(update={"plan": plan, "calls": calls, "note": note[:2000]})


def _with_verdicts(calls: tuple[ModelCall, ...], judged: tuple[ModelCall, ...]) -> tuple[ModelCall, ...]:
    """A whole answer may be of no use: then the planner's word on it stands in the record, not the server's."""
    bad = [call.model_copy(update={"outcome": "ok"}) for call in judged if call.outcome == "invalid"]
    told = [call.model_copy(update={"outcome": "invalid"}) if call in bad else call for call in calls]
    return tuple(told)
