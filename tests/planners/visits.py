"""The planner of `tests.planners.scripted_model` as a process of its own: `python -m tests.planners.visits --site ...`."""

from planners.core import PlannerCore
from planners.modelled import modelled
from tests.planners.scripted_model import VisitPlanner
from wire.process import main
from wire.site import Site


def build(site: Site, process: str) -> PlannerCore:
    return PlannerCore(modelled(VisitPlanner)(site))


if __name__ == "__main__":
    main(build)
