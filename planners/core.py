"""The planner's process without its shell: answers `make_plan`."""

from collections.abc import Sequence
from math import inf

from planners.planner import PLANNERS, Planner
from wire.bus import Event, Node, Request
from wire.messages.plan import PlanRequest
from wire.site import Site, SiteError


class PlannerCore:
    """See wire.bus.Core."""

    def __init__(self, planner: Planner) -> None:
        self._planner = planner

    def start(self, node: Node) -> None:
        node.serve("make_plan")

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        for event in events:
            if isinstance(event, Request) and isinstance(event.message, PlanRequest):
                event.reply(self._planner.make_plan(event.message))

    def rests_until_s(self) -> float:
        """There is nothing to do but to answer."""
        return inf

    def stop(self) -> None:
        """Nothing is held."""


def build(site: Site, process_id: str, planner: str | None = None) -> PlannerCore:
    """The planner that the site file names, or another one by name."""
    name = planner or site.planner.name
    if name not in PLANNERS:
        raise SiteError(f"there is no planner {name!r}; planner.name in the site file can be {', '.join(PLANNERS)}")
    chosen = site.planner.model_copy(update={"name": name})
    return PlannerCore(PLANNERS[name](site.model_copy(update={"planner": chosen})))
