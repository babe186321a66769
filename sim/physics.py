"""The building as rigid bodies: walls and furniture that stand, robots that drive, loose things that can be pushed.

What rests in or on a receptacle is carried by it and needs no body of its own; what lies on the floor has one, asleep
until something touches it. The gripper moves things by changing the scene and telling this module.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import atan2

from sim.boxes import Box, body_box, structure_boxes
from sim.bullet import GRAVITY_MPS2, STEP_S, add_floor, add_static_boxes, open_bullet
from sim.flight.quadrotor import Quadrotor
from sim.legs import legged_rover
from sim.rover import Rover, one_body_rover
from sim.scene import ORIGIN, Body, Scene, Vec2, Vec3
from wire.catalogue import catalogue

RAY, STATIC, FLOOR, LOOSE = 1, 2, 4, 8
FIRST_ROBOT = 16
"""Collision groups (Bullet's rays are in group 1); each robot has one of its own, so that its rays look past itself."""
EVERYTHING = 0x7FFF

DENSITY_KGPM3 = 150.0
LOOSE_MASS_KG = (0.05, 3.0)
CONTACT_M = 0.001
MOVED_M = 1e-4
EPISODE_GAP_S = 0.25
"""Contacts of the same pair that are nearer in time than this are one collision."""
PUSH_EVERY = 4
"""Physics steps from one correction of a robot's velocity, and look at its contacts, to the next."""


@dataclass(frozen=True)
class RobotStart:
    id: str
    position_m: Vec2
    yaw_rad: float


def is_furniture(body: Body) -> bool:
    """Furniture stands where it is; everything that a gripper can take is small and may move."""
    return not catalogue()[body.type].can("pickupable")


class Physics:
    """With `legs` the robots are articulated, at ten times the cost. Drones draw their noise from `seed`."""

    def __init__(
        self,
        scene: Scene,
        robots: Sequence[RobotStart],
        legs: bool = False,
        drones: Sequence[RobotStart] = (),
        seed: int = 0,
    ) -> None:
        self.scene = scene
        self._legs = legs
        self.step_count = 0
        self.collisions = 0
        self.moved: set[int] = set()
        """Keys of what has moved or changed since somebody emptied this set."""
        self.bullet = open_bullet()
        self._last_contact: dict[tuple[str, str], int] = {}
        self._touching: set[str] = set()
        self._at_rest = False
        """The last steps have changed nothing."""
        self._loose: dict[int, int] = {}
        self._add_building()
        self.robots = {start.id: self._add_robot(k, start) for k, start in enumerate(robots)}
        self.drones = {
            start.id: self._add_drone(len(robots) + k, start, seed + 101 * k) for k, start in enumerate(drones)
        }
        self.each_step: list[Callable[[float], None]] = []
        """Called with the time in seconds before every step: what flies decides far more often than a tick comes."""
        self._names = {body.body: body.id for body in self._all()}
        for key in sorted(scene.bodies):
            self.place(key)

    def close(self) -> None:
        self.bullet.disconnect()

    def _add_building(self) -> None:
        bullet = self.bullet
        self.structure = structure_boxes(self.scene)
        """Walls and lintels."""
        self._floor = add_floor(bullet, FLOOR, EVERYTHING & ~(RAY | STATIC))
        furniture = [body_box(b) for _, b in sorted(self.scene.bodies.items()) if is_furniture(b) and not b.gone]
        self.standing = self.structure + furniture
        """All that never moves."""
        add_static_boxes(bullet, self.standing, STATIC, EVERYTHING & ~(STATIC | FLOOR))

    def _add_robot(self, index: int, start: RobotStart) -> Rover:
        group = FIRST_ROBOT << index
        if self._legs:
            return legged_rover(self.bullet, start.id, start.position_m, start.yaw_rad, group, EVERYTHING)
        return one_body_rover(self.bullet, start.id, start.position_m, start.yaw_rad, group, EVERYTHING & ~FLOOR)

    def _all(self) -> list[Rover | Quadrotor]:
        return [*self.robots.values(), *self.drones.values()]

    def _add_drone(self, index: int, start: RobotStart, seed: int) -> Quadrotor:
        if FIRST_ROBOT << index > EVERYTHING:
            raise ValueError(f"{start.id}: one world holds eleven robots and drones, no more")
        place = (*start.position_m, 0.0)
        group, altitude_m = FIRST_ROBOT << index, ORIGIN[2]
        return Quadrotor(self.bullet, start.id, place, start.yaw_rad, seed, group, EVERYTHING, altitude_m=altitude_m)

    # Time

    def advance(self, steps: int) -> None:
        """Let `steps` physics steps of 1/240 s pass. Where they have changed nothing, and nobody is asked to move, they
        change nothing again."""
        rovers = tuple(self.robots.values())
        if self._at_rest and not any(rover.wish.moves for rover in rovers):
            self.step_count += steps
        else:
            before = self._states()
            self._step(rovers, steps)
            self._at_rest = (
                not (self._legs or self._touching or self.drones) and self._states() == before and self._loose_asleep()
            )
        for rover in rovers:
            rover.tilt(steps * STEP_S)

    def _step(self, rovers: Sequence[Rover], steps: int) -> None:
        for _ in range(steps):
            if self.step_count % PUSH_EVERY == 0:
                self._count_contacts()
                for rover in rovers:
                    rover.push(STEP_S, PUSH_EVERY, GRAVITY_MPS2)
            if self.drones:
                self._fly(self.step_count * STEP_S)
            self.bullet.stepSimulation()
            self.step_count += 1
        for rover in rovers:
            rover.moved_on()
        self._follow_loose()

    def _fly(self, now_s: float) -> None:
        for decide in self.each_step:
            decide(now_s)
        for drone in self.drones.values():
            drone.before_step(now_s)

    def _states(self) -> list[object]:
        """Of the robots, to the last bit."""
        return [rover.state() for rover in self.robots.values()]

    def _count_contacts(self) -> None:
        self._touching.clear()
        for robot in self._all():
            for contact in self.bullet.getContactPoints(robot.body):
                other = contact[2] if contact[1] == robot.body else contact[1]
                if contact[8] <= CONTACT_M and other != self._floor:
                    self._touching.add(robot.id)
                    self._note_contact(robot.id, other)

    def _note_contact(self, robot: str, other: int) -> None:
        if other in self._loose.values():
            return  # pushing a ball is no collision
        name = self._names.get(other, "")
        pair = (min(robot, name), max(robot, name))
        before = self._last_contact.get(pair)
        if before is None or (self.step_count - before) * STEP_S > EPISODE_GAP_S:
            self.collisions += 1
        self._last_contact[pair] = self.step_count

    def in_contact(self, robot: str) -> bool:
        """Whether the robot touched anything but the floor when last looked."""
        return robot in self._touching

    # Loose things

    def place(self, key: int) -> None:
        """Make the physics agree with the scene about one thing that was taken, put or lies on the floor."""
        self._at_rest = False
        body = self.scene.bodies[key]
        lies = body.parent is None and body.held_by is None and not body.gone
        if is_furniture(body) or not lies:
            self._drop_body(key)
        elif key not in self._loose:
            self._loose[key] = self._add_loose(body)

    def carry(self, key: int, position_m: Vec3, yaw_rad: float) -> None:
        """Move a thing that a hand holds or lets go, with all that rests in or on it."""
        self.moved |= move_with_contents(self.scene, key, position_m, yaw_rad)

    def _drop_body(self, key: int) -> None:
        bullet_body = self._loose.pop(key, None)
        if bullet_body is not None:
            self.bullet.removeBody(bullet_body)

    def _add_loose(self, body: Body) -> int:
        box = body_box(body)
        volume_m3 = 8.0 * box.half_m[0] * box.half_m[1] * box.half_m[2]
        least, most = LOOSE_MASS_KG
        made: int = self.bullet.createMultiBody(
            max(least, min(most, DENSITY_KGPM3 * volume_m3)),
            self.bullet.createCollisionShape(self.bullet.GEOM_BOX, halfExtents=box.half_m),
            useMaximalCoordinates=1,
            basePosition=box.centre_m,
            baseOrientation=self.bullet.getQuaternionFromEuler((0.0, 0.0, box.yaw_rad)),
        )
        self.bullet.setCollisionFilterGroupMask(made, -1, LOOSE, EVERYTHING)
        for state in (self.bullet.ACTIVATION_STATE_ENABLE_SLEEPING, self.bullet.ACTIVATION_STATE_SLEEP):
            self.bullet.changeDynamics(made, -1, activationState=state)
        return made

    def _follow_loose(self) -> None:
        """Take over into the scene what was pushed; what lies inside a pushed thing goes along."""
        for key, bullet_body in self._loose.items():
            body = self.scene.bodies[key]
            (x, y, z), turn = self.bullet.getBasePositionAndOrientation(bullet_body)
            base_m = (x, y, z - body.size_m[2] / 2.0)
            if max(abs(a - b) for a, b in zip(base_m, body.position_m, strict=True)) > MOVED_M:
                self.moved |= move_with_contents(self.scene, key, base_m, 2.0 * atan2(turn[2], turn[3]))

    def awake_count(self) -> int:
        """How many bodies the solver is busy with."""
        return len(self.robots) + sum(self._loose_speeds())

    def _loose_asleep(self) -> bool:
        return not any(self._loose_speeds())

    def _loose_speeds(self) -> Iterator[bool]:
        """Whether each loose thing moves."""
        for loose in self._loose.values():
            linear, angular = self.bullet.getBaseVelocity(loose)
            yield any(linear) or any(angular)

    # What else there is

    def moving(self, robot: str) -> list[Box]:
        """Boxes of the other robots and of what lies on the floor."""
        others = [other.box() for other in self._all() if other.id != robot]
        return others + [body_box(self.scene.bodies[key]) for key in self._loose]

    def cast(self, robot: str, starts_m: Sequence[Vec3], ends_m: Sequence[Vec3]) -> list[float]:
        """How far along each ray (0 to 1) the first thing is that is not this robot; 1 for none."""
        group = FIRST_ROBOT << list(self.robots).index(robot)
        hits = self.bullet.rayTestBatch(
            starts_m, ends_m, numThreads=1, collisionFilterMask=EVERYTHING & ~(group | FLOOR)
        )
        return [hit[2] for hit in hits]


def move_with_contents(scene: Scene, key: int, position_m: Vec3, yaw_rad: float) -> set[int]:
    """Put a thing somewhere else, together with all that rests in or on it; returns the keys of what moved."""
    body = scene.bodies[key]
    before, after = Box(body.position_m, (0.0, 0.0, 0.0), body.yaw_rad), Box(position_m, (0.0, 0.0, 0.0), yaw_rad)
    body.position_m, body.yaw_rad = position_m, yaw_rad
    moved = {key}
    for child_key, child in scene.bodies.items():
        if child.parent == key:
            offset_m = before.local(child.position_m)
            turned = child.yaw_rad + yaw_rad - before.yaw_rad
            moved |= move_with_contents(scene, child_key, after.site(offset_m), turned)
    return moved
