"""A model whose answers and failures are written down beforehand, and a planner that asks it one question."""

from collections.abc import Sequence

from planners.asking import Answer, Model, ModelFailed, Question, rejected
from planners.tasks.planning import TaskPlanner
from wire.messages.goal import Goal, Selector
from wire.messages.plan import CallOutcome, ModelCall, PlanReply, PlanRequest
from wire.site import Site


class WrittenModel:
    """See planners.asking.Model. Each entry is the text of an answer, or the outcome of a failure as `!outcome`."""

    def __init__(self, script: Sequence[str], tokens: tuple[int, int] = (100, 20), latency_s: float = 1.0) -> None:
        self._script, self._tokens, self._latency_s = list(script), tokens, latency_s
        self.asked: list[Question] = []

    def ask(self, question: Question) -> Answer:
        self.asked.append(question)
        text = self._script.pop(0) if len(self._script) > 1 else self._script[0]
        failed = text.startswith("!")
        outcome: CallOutcome = text[1:] if failed else "ok"  # type: ignore[assignment]
        call = ModelCall(
            purpose=question.purpose,
            model="written",
            outcome=outcome,
            prompt_tokens=self._tokens[0],
            completion_tokens=self._tokens[1],
            latency_s=self._latency_s + 0.001 * len(self.asked),  # no two calls are alike
            seed=question.seed,
        )
        if failed:
            raise ModelFailed(f"written: {outcome}", call)
        return Answer(text, call)


class VisitPlanner:
    """Asks for the name of a room, up to three times, and has it visited."""

    def __init__(self, site: Site, model: Model) -> None:
        self._tasks, self._model = TaskPlanner(site, "visits"), model

    def make_plan(self, request: PlanRequest) -> PlanReply:
        rooms = [area.id for area in request.world.areas]
        useless = []
        for _ in range(3):
            answer = self._model.ask(Question("room", "Answer with a room.", request.instruction))
            if answer.text in rooms:
                goal = Goal(predicate="visited", subject=Selector(room=answer.text), text=answer.text)
                reply = self._tasks.plan(request, [goal])
                return reply.model_copy(update={"calls": tuple(useless)})
            useless.append(rejected(answer))
        raise ModelFailed("written: it names no room", useless[-1], rejects=useless)
