"""One instruction put to a model: a question, the critics' objections, at most two repairs, and what is left of them.

The critics are code and certain of what they object to; a reply to which they object is never planned for. What one
reply got wrong another may have right, so goals that nobody objects to are kept from all of them.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from planners.asking import Answer, Model, ModelFailed, Question, rejected
from planners.goals.mending import mended
from planners.goals.merging import merged
from planners.goals.offered import Offered, schema, user_text
from planners.goals.pronouns import check_pronouns
from planners.goals.reply import Misshapen, Reply, read_reply
from planners.goals.translate import Untranslatable, goals_of
from planners.goals.whole import reply_faults
from planners.goals.wishes import entry_of, wish_faults
from planners.goals.words import Instruction
from planners.prompt import one_line, system_prompt
from planners.scripted.agreement import agree
from planners.scripted.syntax import Unclear
from planners.scripted.texts import told_apart
from wire.messages.goal import Goal
from wire.messages.plan import ModelCall
from wire.messages.world import WorldState

TEMPERATURES = (0.0, 0.0, 0.3)
"""Of the question and of each repair."""
ANSWER_TOKENS = 512
MOST_FAULTS = 6
REPLY_LIMIT = 1200


@dataclass(frozen=True)
class Judged:
    """A reply, its goals where there is nothing against it, and what there is."""

    reply: Reply | None
    goals: tuple[Goal, ...] = ()
    faults: tuple[str, ...] = ()


class Dialogue:
    """Ends with goals, or raises; `calls` has a record of every answer."""

    def __init__(self, model: Model, offered: Offered, instruction: Instruction, world: WorldState) -> None:
        self._model, self._offered, self._instruction, self._world = model, offered, instruction, world
        self.calls: list[ModelCall] = []

    def goals(self) -> tuple[Goal, ...]:
        """Raises Unclear where the model asks or gives up, ModelFailed where no reply of it holds."""
        user = user_text(self._offered, self._instruction.text)
        asked, judged, replies = user, Judged(None), list[Reply]()
        for attempt, temperature in enumerate(TEMPERATURES):
            question = Question(
                purpose="repair" if attempt else "goals",
                system=system_prompt("goals"),
                user=asked,
                schema=schema(self._offered),
                max_tokens=ANSWER_TOKENS,
                temperature=temperature,
                seed=attempt,
            )
            answer = self._model.ask(question)
            judged = self._hear(answer)
            if judged.reply is not None:
                replies.append(judged.reply)
            goals = judged.goals or self._of_all(replies)
            if goals:
                return goals
            asked = f"{user}\n{_objections(answer.text, judged.faults)}"
        raise ModelFailed(f"no goals could be made of it: {judged.faults[0]}", self.calls[-1], rejects=self.calls[:-1])

    def _hear(self, answer: Answer) -> Judged:
        try:
            judged = self.judge(mended(read_reply(answer.text), self._instruction))
        except Misshapen as fault:
            judged = Judged(None, faults=(str(fault),))
        except Unclear:
            self.calls.append(answer.call)
            raise
        self.calls.append(rejected(answer) if judged.faults else answer.call)
        if judged.reply is not None and not judged.faults:
            _end_without_goals(judged.reply)
        return judged

    def _of_all(self, replies: Sequence[Reply]) -> tuple[Goal, ...]:
        """The goals of several replies together, where there is nothing against these."""
        both = merged(replies, self._instruction, self._offered) if len(replies) > 1 else None
        return self.judge(both).goals if both is not None else ()

    def judge(self, reply: Reply) -> Judged:
        """Everything that code can know to be wrong with a reply. Raises Unclear where only the operator can choose."""
        strange = [words for words in reply.unknown if not self._instruction.find(words)]
        if strange:
            return Judged(reply, faults=(f"unknown '{one_line(strange[0], 60)}' is not in the instruction",))
        if reply.ask.strip() or reply.unknown:
            return Judged(reply)
        entries = [entry_of(wish, kept, self._instruction, self._offered) for wish, kept in reply.wishes()]
        faults = [fault for entry in entries for fault in wish_faults(entry, self._instruction, self._offered)]
        if not faults:
            faults = [*check_pronouns(entries, self._instruction), *reply_faults(reply, entries, self._instruction)]
        if faults:
            return Judged(reply, faults=tuple(dict.fromkeys(faults)))
        try:
            goals = agree(goals_of(reply.goals, reply.keep, self._offered, self._world))
        except (Untranslatable, Unclear) as fault:
            return Judged(reply, faults=(str(fault),))
        return Judged(reply, told_apart(goals, {area.id: area.name for area in self._world.areas}))


def _end_without_goals(reply: Reply) -> None:
    """A question of the model's, words that it has no name for, or nothing to do: each an answer to the operator."""
    if reply.ask.strip():
        raise Unclear(one_line(reply.ask, 160), question=True)
    if reply.unknown:
        listed = " and ".join(f"'{one_line(words, 40)}'" for words in reply.unknown[:4])
        raise Unclear(f"I do not understand {listed}", one_line(reply.unknown[0], 40))
    if not reply.goals and not reply.keep:
        raise Unclear("it asks for nothing to be done")


def _objections(text: str, faults: Sequence[str]) -> str:
    """What a repair is asked with; the reply is quoted like any text of a stranger."""
    listed = "\n".join(f"- {one_line(fault, 160)}" for fault in faults[:MOST_FAULTS])
    return f"your reply was: {text[:REPLY_LIMIT]}\nit is wrong:\n{listed}\nreply again, with all of it"
