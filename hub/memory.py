"""The believed world and a task's state as JSON for the journal, and back."""

import json
from typing import Any

from pydantic import TypeAdapter

from hub.plan import PlanRun
from hub.records import Claim, Fact, Sight, Thing
from hub.world import World
from wire.messages.goal import Goal
from wire.messages.plan import NodeState, Plan

_NUMBERS = ("x", "y", "z", "xx", "xy", "yy", "zz", "stamp_s", "belief", "hits", "first_hand_s", "handled_s")
_GOALS = TypeAdapter(tuple[Goal, ...])


def write_world(world: World) -> str:
    """Objects, hands, searched rooms and reputations."""
    return json.dumps(
        {
            "things": [_write_thing(t) for t in world.things if t.shown >= 0],
            "hands": {id: r.inventory for id, r in sorted(world.fleet.robots.items()) if r.inventory is not None},
            "searched": world.areas.searched(),
            "from_above": world.areas.from_above(),
            "trust": {source: list(counts) for source, counts in sorted(world.trust.counts().items())},
            "seq": world.seq,
            "merged": world.things.merged,
        },
        separators=(",", ":"),
    )


def read_world(world: World, text: str) -> None:
    """Bring back what `write_world` wrote into a fresh world."""
    data = json.loads(text)
    for row in data["things"]:
        world.things.bring_back(_read_thing(row))
    for robot, item in data["hands"].items():
        world.fleet.robot(robot).inventory = item
    for room in data["searched"]:
        world.areas.remember_searched(room)
    for room, how in data.get("from_above", {}).items():
        world.areas.remember_from_above(room, how)
    world.trust.restore({source: (right, wrong) for source, (right, wrong) in data["trust"].items()})
    world.seq = data["seq"]
    world.things.merged.update(data["merged"])
    world.lock()


def _write_thing(thing: Thing) -> dict[str, Any]:
    row: dict[str, Any] = {name: round(getattr(thing, name), 5) for name in _NUMBERS}
    row |= {"id": thing.id, "type": thing.type, "receptacle": thing.receptacle, "room": thing.room}
    row |= {"source": thing.last_source, "verified": thing.verified, "votes": thing.votes}
    row |= {"from_above": True} if thing.from_above else {}
    row |= {"looked_into": True} if thing.looked_into else {}
    row["sights"] = {s: [v.robot, v.support, v.stamp_s, v.confidence, v.hits] for s, v in thing.sights.items()}
    row["facts"] = {
        name: {s: [c.probability, c.stamp_s, c.handled] for s, c in fact.claims.items()}
        for name, fact in thing.facts.items()
    }
    return row


def _read_thing(row: dict[str, Any]) -> Thing:
    thing = Thing(row["id"], row["type"], (row["x"], row["y"], row["z"]), row["stamp_s"])
    for name in _NUMBERS:
        setattr(thing, name, row[name])
    thing.receptacle, thing.room, thing.last_source = row["receptacle"], row["room"], row["source"]
    thing.verified, thing.votes = row["verified"], row["votes"]
    thing.from_above, thing.looked_into = row.get("from_above", False), row.get("looked_into", False)
    thing.placed_x, thing.placed_y, thing.placed_z = thing.x, thing.y, thing.z
    for source, (robot, support, stamp_s, confidence, hits) in row["sights"].items():
        sight = thing.sights[source] = Sight(robot)
        sight.support, sight.stamp_s, sight.confidence, sight.hits = support, stamp_s, confidence, hits
    for name, claims in row["facts"].items():
        fact = thing.facts[name] = Fact()
        for source, (probability, stamp_s, handled) in claims.items():
            fact.claims[source] = Claim(probability, stamp_s, handled)
    return thing


def write_run(run: PlanRun) -> dict[str, Any]:
    return {
        "plan": run.plan.model_dump_json(),
        "types": run.types,
        "nodes": [
            [s.node.id, s.status, s.robot, s.goal_id, s.reason, s.started_s, s.ended_s] for s in run.steps.values()
        ],
    }


def read_run(data: dict[str, Any]) -> PlanRun:
    run = PlanRun(Plan.model_validate_json(data["plan"]), data.get("types", {}))
    for id, status, robot, goal_id, reason, started_s, ended_s in data["nodes"]:
        step = run.steps[id]
        NodeState(id=id, status=status, robot=robot, reason=reason, started_s=started_s, ended_s=ended_s)
        step.status, step.robot, step.goal_id, step.reason = status, robot, goal_id, reason
        step.started_s, step.ended_s = started_s, ended_s
    return run


def write_goals(goals: tuple[Goal, ...]) -> str:
    return _GOALS.dump_json(goals).decode()


def read_goals(text: str) -> tuple[Goal, ...]:
    return _GOALS.validate_json(text)
