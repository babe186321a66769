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
        raise Impossible(f"only {' and '.join(away)} can look from above, and is not there now")
    raise Impossible(f"no robot here can look from above: that takes a drone, or another that announces {skill}")


def over_room(predicate: str, room: str, goal: int, centre_m: Vec2, belief: Belief) -> Job:
    """Hover above the middle of a room, or fly over all of it. Raises Impossible."""
    action = OVERHEAD[predicate]
    if room in belief.bans.rooms:
        raise Impossible(f"{room} may not be entered")
    _check_tried(action, room, belief)
    return Job([Step(action, centre_m, room=room)], goal)


def over_thing(predicate: str, obj: ObjectState, goal: int, belief: Belief) -> Job:
    """Hover above a thing. Raises Impossible."""
    action = OVERHEAD[predicate]
    if obj.room in belief.bans.rooms:
        raise Impossible(f"{obj.room} may not be entered")
    _check_tried(action, obj.id, belief)
    return Job([on(action, obj)], goal)


def _check_tried(action: Action, id: str, belief: Belief) -> None:
    if belief.failures.spent(action, id):
        raise Impossible(belief.failures.last(id))
