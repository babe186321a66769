"""Pictures that cameras show to the model: in turn, behind plans, and a model that hangs holds up nobody."""

import threading
from collections.abc import Sequence
from dataclasses import dataclass, field

import pytest

from planners.asking import Answer, ModelFailed, Question
from planners.core import PlannerCore
from planners.looking import LONGEST_WAIT_S, MOST_WAITING, NO_MODEL, Looks
from tests.planners.toy import site
from wire.bus import Event, Node, Request
from wire.keys import SERVICE
from wire.loopback import LoopbackMesh
from wire.messages.look import LookReply, LookRequest
from wire.messages.plan import ModelCall, PlanReply, PlanRequest, Refusal
from wire.messages.world import WorldState
from wire.model import Message

JPEG = b"\xff\xd8 a picture"
CALL = ModelCall(purpose="look", model="double", outcome="ok", stand_in=True)
EMPTY = WorldState(seq=0, stamp_s=0.0, robots=(), objects=(), areas=())


def look(asker: str = "cam-1", **changes: object) -> LookRequest:
    return LookRequest(asker=asker, picture=JPEG, system="You look.", user="What is there?").model_copy(update=changes)


@dataclass
class Recorder:
    """A model that says which question it got, and fails when told to."""

    diary: list[str] = field(default_factory=list)
    fails: str = ""

    def ask(self, question: Question) -> Answer:
        self.diary.append(f"{question.purpose} {question.user}")
        if self.fails:
            raise ModelFailed(self.fails, CALL.model_copy(update={"outcome": "unreachable"}))
        return Answer(f"answer to {question.user}", CALL)


@dataclass
class Hanging:
    """A model that answers when it is let go."""

    entered: threading.Event = field(default_factory=threading.Event)
    let_go: threading.Event = field(default_factory=threading.Event)

    def ask(self, question: Question) -> Answer:
        self.entered.set()
        assert self.let_go.wait(30.0)
        return Answer("late", CALL)


@dataclass
class Refusing:
    """A planner that notes when it was asked."""

    diary: list[str]

    def make_plan(self, request: PlanRequest) -> PlanReply:
        self.diary.append("plan")
        return PlanReply(task=request.task, epoch=request.epoch, refusal=Refusal(reason="for the test"))


@dataclass
class Asked:
    """One request and what came back."""

    message: Message
    service: str = "look_at"
    replies: list[Message] = field(default_factory=list)

    @property
    def event(self) -> Request:
        return Request(self.service, "", self.message, self.replies.append)

    @property
    def reply(self) -> LookReply:
        (reply,) = self.replies
        assert isinstance(reply, LookReply)
        return reply


PLAN = PlanRequest(task="t", epoch=0, instruction="tidy up", world=EMPTY, now_s=0.0)


def run_until_answered(core: PlannerCore, asked: Asked, now_s: float = 0.0) -> None:
    for _ in range(2000):
        core.step(now_s, ())
        if asked.replies:
            return
        threading.Event().wait(0.005)
    raise AssertionError("no answer")


def test_over_the_mesh_a_picture_gets_the_models_words() -> None:
    mesh, model = LoopbackMesh(), Recorder()
    mesh.add(PlannerCore(Refusing([]), Looks(model, time_stands=True)), "planner", "planner")
    reply = mesh.call("look_at", look(), role="cctv")
    assert isinstance(reply, LookReply)
    assert (reply.text, reply.reason, reply.call) == ("answer to What is there?", "", CALL)


def test_without_a_model_it_is_said_what_to_do() -> None:
    mesh = LoopbackMesh()
    mesh.add(PlannerCore(Refusing([]), Looks(None)), "planner", "planner")
    reply = mesh.call("look_at", look(), role="cctv")
    assert isinstance(reply, LookReply)
    assert (reply.text, reply.reason) == ("", NO_MODEL)


def test_a_plan_goes_before_looks_that_came_earlier() -> None:
    model = Recorder()
    core = PlannerCore(Refusing(model.diary), Looks(model, time_stands=True))
    first, second, plan = Asked(look("cam-1", user="1")), Asked(look("cam-2", user="2")), Asked(PLAN, "make_plan")
    core.step(0.0, (first.event, second.event, plan.event))
    core.step(0.1, ())
    assert model.diary == ["plan", "look 1", "look 2"]
    assert second.reply.text == "answer to 2"


def test_one_picture_a_step_and_no_rest_while_one_waits() -> None:
    model = Recorder()
    core = PlannerCore(Refusing([]), Looks(model, time_stands=True))
    core.step(0.0, [Asked(look(f"cam-{n}")).event for n in range(3)])
    assert len(model.diary) == 1
    assert core.rests_until_s() == 0.0
    core.step(0.1, ())
    core.step(0.2, ())
    assert len(model.diary) == 3
    assert core.rests_until_s() > 1e9


def test_a_hanging_model_holds_up_neither_plans_nor_steps() -> None:
    model, diary = Hanging(), []
    core = PlannerCore(Refusing(diary), Looks(model))
    slow, plan, other = Asked(look("cam-1")), Asked(PLAN, "make_plan"), Asked(look("cam-2"))
    core.step(0.0, (slow.event,))
    assert model.entered.wait(10.0)
    core.step(0.1, (plan.event, other.event))
    assert diary == ["plan"]
    assert not slow.replies
    assert not other.replies, "one question at a time"
    model.let_go.set()
    run_until_answered(core, slow)
    run_until_answered(core, other)
    assert (slow.reply.text, other.reply.text) == ("late", "late")


def test_a_newer_picture_takes_the_place_of_one_that_waits() -> None:
    model = Hanging()
    core = PlannerCore(Refusing([]), Looks(model))
    core.step(0.0, (Asked(look("cam-9")).event,))
    assert model.entered.wait(10.0)
    old, new = Asked(look("cam-1")), Asked(look("cam-1"))
    core.step(0.1, (old.event, new.event))
    assert "a newer picture of cam-1" in old.reply.reason
    model.let_go.set()
    run_until_answered(core, new)
    assert new.reply.text == "late"


def test_who_waited_too_long_is_told_and_not_asked_about() -> None:
    model = Recorder()
    looks = Looks(model, time_stands=True)
    late = Asked(look())
    looks.take(late.event, look(), 0.0)
    looks.step(LONGEST_WAIT_S + 1.0)
    assert model.diary == []
    assert "no time for it" in late.reply.reason


def test_the_queue_has_an_end() -> None:
    looks = Looks(Recorder(), time_stands=True)
    asked = [Asked(look(f"cam-{n}")) for n in range(MOST_WAITING + 1)]
    for one in asked:
        looks.take(one.event, one.message, 0.0)  # type: ignore[arg-type]
    assert "wait already" in asked[-1].reply.reason
    assert not any(one.replies for one in asked[:-1])


def test_a_failure_comes_back_as_its_sentence_and_its_record() -> None:
    core = PlannerCore(Refusing([]), Looks(Recorder(fails="no server at 127.0.0.1:11434"), time_stands=True))
    asked = Asked(look())
    core.step(0.0, (asked.event,))
    assert asked.reply.reason == "no server at 127.0.0.1:11434"
    assert asked.reply.call is not None
    assert asked.reply.call.outcome == "unreachable"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"picture": b"GIF89a"}, "no JPEG or PNG"),
        ({"answer_schema": "{"}, "answer_schema"),
        ({"answer_schema": "[1]"}, "a JSON object is expected"),
    ],
)
def test_what_cannot_be_asked_is_refused_with_its_reason(changes: dict[str, object], words: str) -> None:
    model = Recorder()
    core = PlannerCore(Refusing([]), Looks(model, time_stands=True))
    asked = Asked(look(**changes))
    core.step(0.0, (asked.event,))
    assert words in asked.reply.reason
    assert model.diary == []


def test_an_endless_answer_is_not_passed_on() -> None:
    class Endless:
        def ask(self, question: Question) -> Answer:
            return Answer("x" * 40_000, CALL)

    core = PlannerCore(Refusing([]), Looks(Endless(), time_stands=True))
    asked = Asked(look())
    core.step(0.0, (asked.event,))
    assert "longer than" in asked.reply.reason


def test_cameras_and_robots_may_ask_and_the_hub_has_no_need_to() -> None:
    class Asker:
        def start(self, node: Node) -> None:
            node.ask("look_at", look())

        def step(self, now_s: float, events: Sequence[Event]) -> None: ...
        def stop(self) -> None: ...

    assert SERVICE["look_at"].callers == ("cctv", "robot")
    mesh = LoopbackMesh()
    mesh.add(Asker(), "hub", "hub")
    with pytest.raises(PermissionError, match="role hub may not call look_at"):
        mesh.tick()
    assert site().planner.name == "scripted"
