"""What a quadruped can do: the table that its card announces and that commands are looked up in."""

from collections.abc import Callable

from devices.quadruped import moves
from devices.quadruped.robot import Robot
from devices.skill import Skill
from wire.messages.command import Command

QuadrupedSkill = Skill[Callable[[Robot, Command], moves.Skilled]]

SKILLS: dict[str, QuadrupedSkill] = {
    skill.name: skill for skill in (QuadrupedSkill("goto", moves.Destination, moves.goto),)
}
