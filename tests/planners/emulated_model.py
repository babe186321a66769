"""The emulated planner as a model at hand, without its server: what is asked and answered is kept."""

from planners.asking import Answer, Question
from tests.ollama_double.brain import ChatRequest, emulated
from tests.ollama_double.counting import counter
from tests.ollama_double.dials import Dials
from wire.messages.plan import ModelCall

COUNTER = counter()


class EmulatedModel:
    """See planners.asking.Model."""

    def __init__(self, dials: Dials | None = None) -> None:
        self._brain = emulated(dials or Dials())
        self.said: list[tuple[Question, str]] = []

    def ask(self, question: Question) -> Answer:
        text = self._brain.reply(seen(question))
        self.said.append((question, text))
        call = ModelCall(
            purpose=question.purpose,
            model="stand-in",
            outcome="ok",
            prompt_tokens=tokens(question),
            completion_tokens=COUNTER.count(text),
            counted_by=COUNTER.name,
            seed=question.seed,
            stand_in=True,
        )
        return Answer(text, call)

    @property
    def purposes(self) -> list[str]:
        return [question.purpose for question, _ in self.said]


def seen(question: Question) -> ChatRequest:
    """The question as a brain gets it."""
    return ChatRequest(
        model="stand-in",
        system=question.system,
        user=question.user,
        messages=(("system", question.system), ("user", question.user)),
        schema=question.schema,
        seed=question.seed,
        temperature=question.temperature,
        num_predict=question.max_tokens,
    )


def tokens(question: Question) -> int:
    """Of a prompt."""
    return COUNTER.count(question.system) + COUNTER.count(question.user)
