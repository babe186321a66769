"""What a quadruped can do: the table that its card announces and that commands are looked up in."""

from collections.abc import Callable

from devices.quadruped import handle, moves, search
from devices.quadruped.robot import Robot
from devices.skill import Skill
from wire.messages.command import Command

QuadrupedSkill = Skill[Callable[[Robot, Command], moves.Skilled]]

SKILLS: dict[str, QuadrupedSkill] = {
    skill.name: skill
    for skill in (
        QuadrupedSkill("goto", moves.Destination, moves.goto),
        QuadrupedSkill("explore", search.Search, search.explore),
        QuadrupedSkill("inspect", handle.OnTarget, search.inspect),
        QuadrupedSkill("pickup", handle.OnTarget, handle.pickup),
        QuadrupedSkill("put", handle.OnTargetWithItem, handle.put),
        QuadrupedSkill("open", handle.OnTarget, handle.open_),
        QuadrupedSkill("close", handle.OnTarget, handle.close),
        QuadrupedSkill("toggle_on", handle.OnTarget, handle.toggle_on),
        QuadrupedSkill("toggle_off", handle.OnTarget, handle.toggle_off),
        QuadrupedSkill("slice", handle.OnTarget, handle.slice_),
        QuadrupedSkill("clean", handle.OnTarget, handle.clean),
    )
}
