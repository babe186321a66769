"""A brain as a model without a server between: for tests of what is around the questions, not of the wire to Ollama."""

from collections.abc import Callable

from planners.asking import Answer, ModelFailed, Question
from tests.ollama_double.brain import Brain, ChatRequest
from wire.messages.plan import ModelCall


class InProcess:
    """See planners.asking.Model."""

    def __init__(self, brain: Brain | Callable[[Question], str]) -> None:
        self._brain = brain
        self.questions: list[Question] = []
        self.fault = ""
        """Fails with this sentence as long as it is set."""

    def ask(self, question: Question) -> Answer:
        self.questions.append(question)
        call = ModelCall(purpose=question.purpose, model="brain", outcome="ok", stand_in=True)
        if self.fault:
            raise ModelFailed(self.fault, call.model_copy(update={"outcome": "unreachable"}))
        if not hasattr(self._brain, "reply"):
            return Answer(self._brain(question), call)
        request = ChatRequest(
            "brain", question.system, question.user, (), question.schema, question.pictures, question.seed
        )
        return Answer(self._brain.reply(request), call)
