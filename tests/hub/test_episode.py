"""Algorithm 1 over the in-memory mesh: toy robots, a camera, a list of plans."""

from collections.abc import Callable, Sequence
from pathlib import Path

from tests.hub.home import GOALS, Flat
from tests.hub.scenes import card, seen
from tests.hub.toys import ToyPlanner
from wire.bus import Event
from wire.messages.goal import Goal, Selector
from wire.messages.observation import ObjectObservation
from wire.messages.operator import ControlReply, ControlRequest, TaskQuery, TaskRequest, WhyRequest
from wire.messages.plan import Plan, PlanNode, PlanReply, PlanRequest, Refusal
from wire.messages.world import ObjectState


def _find(request: PlanRequest, type: str) -> ObjectState:
    return next(o for o in request.world.objects if o.type == type)


def fetch(request: PlanRequest) -> PlanReply:
    """Open the fridge, take the apple, put it in; what is so already is left out."""
    apple, fridge = _find(request, "Apple"), _find(request, "Fridge")
    nodes: list[PlanNode] = []
    opened = "isOpen" in fridge.props and fridge.props["isOpen"].value
    if not opened:
        nodes.append(PlanNode(id="open", action="open", object=fridge.id))
    held = any(r.inventory == apple.id for r in request.world.robots)
    if not held:
        nodes.append(PlanNode(id="take", action="pickup", object=apple.id))
    after = tuple(n.id for n in nodes)
    nodes.append(
        PlanNode(
            id="put",
            action="put",
            object=fridge.id,
            item=apple.id,
            same_robot_as=None if held else "take",
            after=after,
        )
    )
    plan = Plan(id="p-1", task=request.task, planner="toy", goals=GOALS, nodes=tuple(nodes))
    return PlanReply(task=request.task, epoch=request.epoch, plan=plan)


def test_an_apple_goes_into_the_fridge() -> None:
    home = Flat(fetch)
    home.mesh.run(3.0)
    home.ask()
    state = home.until_end()
    assert state.status == "done", state
    assert state.goals[0].holds
    assert (state.nodes_done, state.nodes_total, state.fails) == (3, 3, 0)
    assert state.path_m > 3.0
    why = home.mesh.call("why", WhyRequest(object="the apple in the living room"))
    assert "Fridge" in why.text


def test_open_and_pickup_are_done_by_two_robots_at_once() -> None:
    home = Flat(fetch)
    home.mesh.run(3.0)
    home.ask()
    home.until_end()
    done = {home.actions(r.goal_id).split()[-1]: robot.id for robot in home.robots for r in robot.results}
    assert done["pickup"] == done["put"] == "dog-1"
    assert done["open"] == "dog-2"


def test_a_failed_action_halts_and_is_planned_again() -> None:
    failing = iter(["blocked"])
    home = Flat(fetch, fail=lambda c: next(failing, None) if c.action == "pickup" else None)
    home.mesh.run(3.0)
    home.ask()
    state = home.until_end()
    assert state.status == "done"
    assert (state.fails, state.replans) == (1, 1)
    assert "blocked" in home.planner.requests[1].failures[-1]


def test_max_fails_ends_the_task_with_the_reason() -> None:
    home = Flat(fetch, fail=lambda c: "blocked" if c.action == "pickup" else None)
    home.mesh.run(3.0)
    home.ask()
    state = home.until_end(300.0)
    assert state.status == "failed"
    assert "blocked" in state.reason
    assert state.fails == 5


def test_a_refusal_ends_the_task_and_nothing_moves() -> None:
    refusal = Refusal(reason="there is no unicorn in this house", part="unicorn")
    home = Flat(lambda r: PlanReply(task=r.task, epoch=r.epoch, refusal=refusal))
    home.mesh.run(2.0)
    home.ask("feed the unicorn")
    state = home.until_end(20.0)
    assert state.status == "refused"
    assert state.refusal == refusal
    assert all(robot.walked == 0.0 for robot in home.robots)


def test_an_impossible_plan_is_refused_with_reasons_for_the_planner() -> None:
    def put_first(request: PlanRequest) -> PlanReply:
        apple, fridge = _find(request, "Apple"), _find(request, "Fridge")
        nodes = (PlanNode(id="put", action="put", object=fridge.id, item=apple.id),)
        plan = Plan(id="p-1", task=request.task, planner="toy", goals=GOALS, nodes=nodes)
        return PlanReply(task=request.task, epoch=request.epoch, plan=plan)

    home = Flat(put_first)
    home.mesh.run(2.0)
    home.ask()
    state = home.until_end(60.0)
    assert state.status == "failed"
    assert any("pick it up first" in text for text in home.planner.requests[1].failures)
    assert all(robot.walked == 0.0 for robot in home.robots)


def test_a_search_ends_when_the_looked_for_thing_appears() -> None:
    def answer(request: PlanRequest) -> PlanReply:
        if any(o.type == "Mug" for o in request.world.objects):
            goals = (Goal(predicate="found", subject=Selector(type="Mug", count=None)),)
            mug = _find(request, "Mug")
            nodes = (PlanNode(id="look", action="inspect", object=mug.id),)
            plan = Plan(id="p-2", task=request.task, planner="toy", goals=goals, nodes=nodes)
        else:
            rooms = ("living", "bath", "kitchen")
            nodes = tuple(PlanNode(id=f"x-{r}", action="explore", room=r, looking_for=("Mug",)) for r in rooms)
            plan = Plan(id="p-1", task=request.task, planner="toy", goals=(), nodes=nodes, complete=False)
        return PlanReply(task=request.task, epoch=request.epoch, plan=plan)

    home = Flat(answer)
    look = home._look

    def with_mug(now_s: float) -> Sequence[ObjectObservation]:
        return [*look(now_s), seen("Mug", 2.3, 1.8, 0.8, "mug")] if now_s > 6.0 else look(now_s)

    home._look = with_mug
    home.mesh._arriving[2].core.look = with_mug
    home.mesh.run(2.0)
    home.ask("find the mug")
    state = home.until_end()
    assert state.status == "done", state
    assert state.replans == 1
    assert any(r.status == "cancelled" for robot in home.robots for r in robot.results)


def test_stop_halts_robots_and_cancels() -> None:
    home = Flat(fetch)
    home.mesh.run(3.0)
    home.ask()
    home.mesh.run(2.0)
    reply = home.mesh.call("control", ControlRequest(verb="stop"))
    assert isinstance(reply, ControlReply)
    assert reply.ok
    assert home.until_end(20.0).status == "cancelled"
    walked = [robot.walked for robot in home.robots]
    home.mesh.run(3.0)
    assert [robot.walked for robot in home.robots] == walked


def test_pause_and_resume() -> None:
    home = Flat(fetch)
    home.mesh.run(3.0)
    home.ask()
    home.mesh.run(2.0)
    home.mesh.call("control", ControlRequest(verb="pause"))
    home.mesh.run(3.0)
    assert home.mesh.call("task_query", TaskQuery()).status == "paused"
    home.mesh.call("control", ControlRequest(verb="resume", task="t-1"))
    assert home.until_end().status == "done"


def test_the_same_task_id_again_is_the_same_task() -> None:
    home = Flat(fetch)
    home.mesh.run(3.0)
    home.ask()
    again = home.ask("something else")
    assert again.instruction == "put the apple in the fridge"
    assert home.until_end().status == "done"


def test_a_second_task_waits_for_the_first() -> None:
    home = Flat(fetch)
    home.mesh.run(3.0)
    home.ask()
    second = home.mesh.call("task", TaskRequest(task="t-2", instruction="again"))
    assert second.reason == "waits for task t-1 to end"
    home.until_end()
    home.mesh.run(5.0)
    assert home.mesh.call("task_query", TaskQuery(task="t-2")).status != "planning"


def test_a_robot_that_dies_is_planned_around() -> None:
    home = Flat(fetch)
    home.mesh.run(3.0)
    home.ask()
    home.mesh.run(1.0)
    home.mesh.remove("dog-2", stop=False)
    state = home.until_end()
    assert state.status == "done"
    assert state.replans >= 1
    assert state.fails == 0


def _in_part(request: PlanRequest) -> PlanReply:
    reply = fetch(request)
    assert reply.plan is not None
    return reply.model_copy(update={"plan": reply.plan.model_copy(update={"complete": False})})


def _with_a_newcomer(planner: Callable[[PlanRequest], PlanReply]) -> tuple[Flat, int]:
    """While its plan runs, one more skill is announced; and how often the planner had been asked before that."""
    home = Flat(planner)
    home.mesh.run(3.0)
    home.ask()
    home.mesh.run(1.0)
    asked = len(home.planner.requests)
    fleet = home.hub.world.fleet
    fleet.take_card(card("dog-2", (*fleet.robot("dog-2").skills, "inspect_from_above")))
    home.mesh.run(2.0)
    return home, asked


def test_who_comes_late_and_can_what_nobody_could_is_planned_for() -> None:
    home, asked = _with_a_newcomer(_in_part)
    assert len(home.planner.requests) == asked + 1
    assert "inspect_from_above" in [skill.name for skill in home.planner.requests[-1].skills]
    home.mesh.run(1.0)
    assert len(home.planner.requests) == asked + 1, "not again for the same"
    state = home.mesh.call("task_query", TaskQuery(task="t-1"))
    assert any("dog-2 can help now" in line for line in state.log), state.log


def test_a_plan_that_leaves_nothing_open_is_not_made_anew_for_a_newcomer() -> None:
    home, asked = _with_a_newcomer(fetch)
    assert len(home.planner.requests) == asked


class _Silent(ToyPlanner):
    """Dies before it answers."""

    def step(self, now_s: float, events: Sequence[Event]) -> None: ...


def test_a_planner_that_dies_while_it_plans_is_asked_again_as_soon_as_it_is_back() -> None:
    home = Flat(fetch)
    home.mesh.run(1.0)
    home.mesh.remove("planner", stop=False)
    home.mesh.add(_Silent(fetch), "planner", "planner")
    home.mesh.run(2.0)
    home.ask()
    home.mesh.run(1.0)
    home.mesh.remove("planner", stop=False)
    home.mesh.run(2.0)
    home.mesh.add(home.planner, "planner", "planner")
    home.mesh.run(2.0)
    assert home.planner.requests
    state = home.until_end()
    assert state.status == "done"
    assert state.fails == 1


def test_a_killed_hub_goes_on_without_repeating_a_finished_step(tmp_path: Path) -> None:
    for killed_after_s in (1.0, 4.0, 7.0, 10.0, 13.0):
        home = Flat(fetch, journal=tmp_path / f"{killed_after_s}.db")
        home.mesh.run(3.0)
        home.ask()
        home.mesh.run(killed_after_s)
        home.mesh.remove("hub", stop=False)
        home.mesh.run(2.5)
        home.start_hub()
        state = home.until_end()
        assert state.status == "done", (killed_after_s, state)
        done = [home.actions(r.goal_id).split()[-1] for robot in home.robots for r in robot.results if r.code == "ok"]
        assert sorted(done) == ["open", "pickup", "put"], killed_after_s
        home.mesh.close()


def test_two_equal_runs_write_equal_journals() -> None:
    def play() -> list[tuple[float, str, str]]:
        home = Flat(fetch)
        home.mesh.run(3.0)
        home.ask()
        home.until_end()
        return home.hub._journal.log()

    assert play() == play()
