"""Looks from above: who can do them, and the jobs that make such a goal true of a room or of a thing."""

from planners.tasks.belief import Belief
from planners.tasks.work import Impossible, Job, Step, on
from wire.messages.plan import FROM_ABOVE, Action
from wire.messages.world import ObjectState
from wire.model import Vec2

OVERHEAD: dict[str, Action] = {predicate: action for action, predicate in FROM_ABOVE.items()}
"""Predicate -> the skill that makes it true."""


def check_able(predicate: str, belief: Belief) -> None:
    """Raises Impossible where no robot that is there announces the skill: before anything is looked for in vain."""
    skill = OVERHEAD[predicate]
    if any(skill in robot.skills for robot in belief.robots):
        return
    away = [robot.id for robot in belief.world.robots if skill in robot.skills]
    if away:
        are = "is" if len(away) == 1 else "are"
        raise Impossible(f"only {' and '.join(away)} can look from above, and {are} not there now")
    raise Impossible(f"no robot here can look from above: that takes a drone, or another that announces {skill}")


def over_room(predicate: str, room: str, goal: int, centre_m: Vec2, belief: Belief) -> Job:
    """Hover above the middle of a room, or fly over all of it. Raises Impossible."""
    return _look(Step(OVERHEAD[predicate], centre_m, room=room), room, room, goal, belief)


def over_thing(predicate: str, obj: ObjectState, goal: int, belief: Belief) -> Job:
    """Hover above a thing. Raises Impossible."""
    return _look(on(OVERHEAD[predicate], obj), obj.id, obj.room, goal, belief)


def _look(step: Step, about: str, room: str | None, goal: int, belief: Belief) -> Job:
    if room in belief.bans.rooms:
        raise Impossible(f"{room} may not be entered")
    if belief.failures.spent(step.action, about):
        raise Impossible(belief.failures.last(about))
    return Job([step], goal)
