"""The planner's process without its shell: answers `make_plan`, and when nobody wants a plan, `look_at`."""

from collections.abc import Sequence
from math import inf

from planners.looking import Looks
from planners.opening import vision_of
from planners.planner import PLANNERS, Planner
from wire.bus import Event, Node, Request
from wire.clock import owner_of
from wire.messages.look import LookRequest
from wire.messages.plan import PlanRequest
from wire.site import Site, SiteError


class PlannerCore:
    """See wire.bus.Core."""

    def __init__(self, planner: Planner, looks: Looks | None = None) -> None:
        self._planner, self._looks = planner, looks or Looks(None)

    def start(self, node: Node) -> None:
        node.serve("make_plan")
        node.serve("look_at")

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        for event in events:
            match event:
                case Request(message=PlanRequest() as request):
                    event.reply(self._planner.make_plan(request))
                case Request(message=LookRequest() as look):
                    self._looks.take(event, look, now_s)
        self._looks.step(now_s)

    def rests_until_s(self) -> float:
        """There is nothing to do but to answer."""
        return 0.0 if self._looks.busy else inf

    def stop(self) -> None:
        """Nothing is held."""


def build(site: Site, process_id: str, planner: str | None = None) -> PlannerCore:
    """The planner that the site file names, or another one by name."""
    name = planner or site.planner.name
    if name not in PLANNERS:
        raise SiteError(f"there is no planner {name!r}; planner.name in the site file can be {', '.join(PLANNERS)}")
    chosen = site.planner.model_copy(update={"name": name})
    looks = Looks(vision_of(site), time_stands=bool(owner_of(site)))
    return PlannerCore(PLANNERS[name](site.model_copy(update={"planner": chosen})), looks)
