"""All that a skill has to work with."""

from dataclasses import dataclass

from devices.quadruped.body import Body
from wire.site import Room, Site


@dataclass(frozen=True)
class Robot:
    body: Body
    site: Site

    def room(self, id: str) -> Room | None:
        return next((room for room in self.site.room if room.id == id), None)
