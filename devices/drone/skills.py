"""What a drone can do: the table that its card announces and that commands are looked up in.

It announces neither `inspect` nor `explore`: the hub takes their results for facts about things and rooms, and this
process does not look at its pictures.
"""

from collections.abc import Callable

from devices.drone import looks, moves
from devices.drone.craft import Craft
from devices.skill import Skill
from wire.messages.command import Command

DroneSkill = Skill[Callable[[Craft, Command], moves.Skilled]]

SKILLS: dict[str, DroneSkill] = {
    skill.name: skill
    for skill in (
        DroneSkill("take_off", moves.Height, moves.take_off),
        DroneSkill("land", moves.Nothing, moves.land),
        DroneSkill("goto", moves.Destination, moves.goto),
        DroneSkill("hold", moves.Pause, moves.hold),
        DroneSkill("return_home", moves.Nothing, moves.return_home),
        DroneSkill("follow_path", moves.Way, moves.follow_path),
        DroneSkill("orbit", looks.Orbit, looks.orbit),
        DroneSkill("look_at", looks.LookAt, looks.look_at),
        DroneSkill("inspect_from_above", looks.FromAbove, looks.inspect_from_above),
        DroneSkill("construct_map", looks.Survey, looks.construct_map),
        DroneSkill("take_picture", moves.Nothing, looks.take_picture),
    )
}
