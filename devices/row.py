"""A robot's row of the site file, for the process that drives it."""

from wire.site import Robot, Site, SiteError


def robot_row(site: Site, id: str, kind: str, moved: str) -> Robot:
    """`moved`: what the process does to robots of that kind. Raises SiteError."""
    row = next((robot for robot in site.robot if robot.id == id), None)
    if row is None:
        raise SiteError(f"the site has no robot {id}: add a [[robot]] table with this id to the site file")
    if row.kind != kind:
        raise SiteError(f"robot {id} is a {row.kind} in the site file: a {kind} is {moved} here, run its own module")
    return row
