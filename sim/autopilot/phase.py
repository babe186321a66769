"""Whether what goes on is a take-off or a landing."""

from sim.autopilot.flying import Activity, Climb, Descend, GoHome
from sim.autopilot.guided import Guided
from sim.autopilot.legs import Landing
from sim.autopilot.mission_run import MissionRun


def _inner(activity: Activity | None) -> Activity | None:
    if isinstance(activity, MissionRun):
        return activity.leg
    return activity.rest if isinstance(activity, Guided) else activity


def taking_off(activity: Activity) -> bool:
    inner = _inner(activity)
    return isinstance(inner, Climb) and not inner.done


def landing(activity: Activity) -> bool:
    inner = _inner(activity)
    if isinstance(inner, GoHome):
        return inner.landing_now
    return isinstance(inner, Descend) or (isinstance(inner, Landing) and inner.way.done)
