"""Who does which errand: somebody who has the skills, has least to do, and is near."""

from tests.ollama_double.planning.errands import Errand
from tests.ollama_double.planning.prompt_text import Known


def share_out(errands: list[Errand], known: Known) -> None:
    """Name a robot for each; none where nobody has the skills."""
    load = dict.fromkeys(known.robots, 0)
    for errand in errands:
        holder = next((r.name for r in known.robots.values() if r.holds and errand.steps[0].item == r.holds), "")
        errand.robot = (
            holder
            if holder and errand.steps[0].do != "pickup"
            else least_busy(_able(errand, known), errand, load, known)
        )
        if errand.robot:
            load[errand.robot] += len(errand.steps) + 3 * sum(step.do == "explore" for step in errand.steps)


def _able(errand: Errand, known: Known) -> list[str]:
    needed = {step.do for step in errand.steps}
    return [robot.name for robot in known.robots.values() if needed <= robot.skills]


def least_busy(able: list[str], errand: Errand, load: dict[str, int], known: Known) -> str:
    """Of those who can."""
    room, name = errand.place
    thing = known.things.get(name)
    there = room or (thing.room if thing is not None else "")
    return min(able, key=lambda robot: (load[robot] + (known.robots[robot].room != there), robot), default="")
