"""What the edges of a plan say: what is surely done before a node, which nodes one robot must do."""

from collections.abc import Sequence

from wire.messages.plan import Plan


def ancestors(plan: Plan, order: Sequence[str]) -> dict[str, set[str]]:
    """Node -> every node that is surely done before it. `order` respects the edges."""
    after = {node.id: node.after for node in plan.nodes}
    before: dict[str, set[str]] = {}
    for id in order:
        before[id] = set(after[id]).union(*(before[a] for a in after[id]))
    return before


def chains(plan: Plan) -> dict[str, str]:
    """Node -> the name of its chain: nodes tied to each other by `same_robot_as` have the same."""
    chain = {node.id: node.id for node in plan.nodes}
    for node in plan.nodes:
        if node.same_robot_as is not None:
            old, new = chain[node.id], chain[node.same_robot_as]
            chain = {id: new if name == old else name for id, name in chain.items()}
    return chain
