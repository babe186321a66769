"""A skill asked for by its name, which is how one is asked for whose effect no goal can say.

    [ROBOT:] do SKILL [on OBJECT | in ROOM] [PARAMETER=VALUE ...]
    [ROBOT:] inspect OBJECT or ROOM from above [PARAMETER=VALUE ...]

The object or the room is said in words or by its id. Skills that goals are reached with are not asked for in this way.
"""

import json
import re
from collections.abc import Iterator
from contextlib import suppress

from planners.scripted.goals import read_goals
from planners.scripted.syntax import Unclear
from planners.tasks.failures import GIVE_UP
from planners.tasks.planning import plan_id
from wire.goals import select
from wire.messages.goal import Selector
from wire.messages.plan import KNOWN_ACTIONS, Param, Plan, PlanNode, PlanRequest, SkillCard

_TOLD = re.compile(r"(?:(?P<robot>[a-z0-9-]+) *[:,] *)?do +(?P<skill>[a-z][a-z0-9_]*)\b(?P<rest>.*)", re.I | re.S)
_FROM_ABOVE = re.compile(
    r"(?P<robot>[a-z0-9-]+ *[:,] *)?(?:inspect|check|look at|view|see|photograph) +(?P<place>.+?) +from +above\b(?P<rest>.*)",
    re.I | re.S,
)
_FOR_GOALS = KNOWN_ACTIONS - {"goto"}
"""Left to goals. No goal says where a robot shall be."""
_FROM_ABOVE_SKILL = "inspect_from_above"
_PARAMETER = re.compile(r"\b([A-Za-z]\w{0,31})=(\S+)")


def read_told(request: PlanRequest, planner: str) -> Plan | None:
    """The plan that the instruction spells out; None when it names no skill. Raises Unclear when it cannot be done."""
    instruction = request.instruction.strip().rstrip(".!")
    above = _FROM_ABOVE.fullmatch(instruction)
    if above is not None and (_addressed(above["robot"], request) or _PARAMETER.search(above["rest"])):
        instruction = f"{above['robot'] or ''}do {_FROM_ABOVE_SKILL} in {above['place']}{above['rest']}"
    told = _TOLD.fullmatch(instruction)
    if told is None:
        return None
    name = told["skill"].lower()
    card = next((card for card in request.skills if card.name == name), None)
    if name in _FOR_GOALS or (card is None and "_" not in name):
        return None
    if card is None:
        others = sorted({c.name for c in request.skills} - _FOR_GOALS)
        raise Unclear(f"no robot here announces the skill {name}; asked for by name can be {_listed(others)}", name)
    vain = [sentence for sentence in request.failures if name in sentence]
    if len(vain) >= GIVE_UP:
        raise Unclear(vain[-1], name)
    robot = _robot(told["robot"], request)
    params = dict(_params(told["rest"]))
    places = _places(_PARAMETER.sub("", told["rest"]), card, request)
    nodes = tuple(
        PlanNode(
            id=f"n{number}",
            action=name,
            object=object,
            room=room,
            params=params,
            req_skills=(name,),
            preferred_robot=robot,
        )
        for number, (object, room) in enumerate(places, start=1)
    )
    return Plan(id=plan_id(request), task=request.task, planner=planner, goals=(), nodes=nodes)


def _addressed(words: str | None, request: PlanRequest) -> bool:
    """Whether an instruction begins with the name of a robot, and not with "please,"."""
    name = (words or "").strip()
    return name.endswith(":") or name.rstrip(" ,").lower() in {robot.id for robot in request.world.robots}


def _listed(names: list[str]) -> str:
    return ", ".join(names) or "none of those that are here"


def _robot(name: str | None, request: PlanRequest) -> str | None:
    if name is None:
        return None
    ids = [robot.id for robot in request.world.robots]
    if name.lower() not in ids:
        raise Unclear(f"there is no robot {name}; the robots are {_listed(ids)}", name)
    return name.lower()


def _params(text: str) -> Iterator[tuple[str, Param]]:
    for match in _PARAMETER.finditer(text):
        try:
            value = json.loads(match[2])
        except ValueError:
            value = match[2]
        yield match[1], value if isinstance(value, bool | int | float) else match[2]


def _places(text: str, card: SkillCard, request: PlanRequest) -> list[tuple[str | None, str | None]]:
    """The object or the room that each node is about. A skill that takes both may have either after `in`."""
    words = re.sub(r"^\s*(on|to|in|with)\b", "", text, flags=re.I).strip(" ,")
    if not words:
        return [(None, None)]
    takes_object = '"target"' in card.parameters
    if takes_object and '"room"' in card.parameters and re.match(r"\s*in\b", text, re.I):
        with suppress(Unclear):
            return _rooms(words, request)
    if takes_object:
        found = read_goals(f"find {words}", request.world)
        return [(id, None) for goal in found for id in _objects(goal.subject, words, request)]
    return _rooms(words, request)


def _rooms(words: str, request: PlanRequest) -> list[tuple[str | None, str | None]]:
    goals = read_goals(f"go to {words}", request.world)
    if any(goal.subject.room is None or goal.subject.type is not None for goal in goals):
        raise Unclear(f"'{words}' is no room", words)
    return [(None, goal.subject.room) for goal in goals]


def _objects(selector: Selector, words: str, request: PlanRequest) -> list[str]:
    ids = sorted(obj.id for obj in select(selector, request.world))
    if not ids:
        raise Unclear(f"nothing is known yet of '{words}': ask to find it first", words)
    if selector.count is None or selector.count == len(ids):
        return ids
    raise Unclear(f"which one is '{words}'? Known are {', '.join(ids)}", words, question=True)
