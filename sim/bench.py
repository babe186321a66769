"""How fast the physics is: a furnished home with a drone-like box and two driving robots, two ways of building it.

    python -m sim.bench --json

`compound` is what the simulator does, also with articulated legs; `separate` gives every wall, piece of furniture and
small thing a body of its own, awake. All run the same commands in the same process, one after the other, so that their
ratios mean something.
"""

import argparse
import json
import sys
from collections.abc import Callable
from random import Random
from time import process_time
from typing import Any

from sim.boxes import body_box, structure_boxes
from sim.bullet import GRAVITY_MPS2, STEP_S, add_static_boxes, open_bullet
from sim.generator import make_home
from sim.physics import EVERYTHING, FIRST_ROBOT, FLOOR, LOOSE, PUSH_EVERY, STATIC, Physics, RobotStart, is_furniture
from sim.rover import Rover, Wish, one_body_rover
from sim.scene import Scene

DRONE_KG = 1.2
DRONE_HALF_M = (0.2, 0.2, 0.05)
DRONE_HEIGHT_M = 1.5
TICK_STEPS = 12
NEW_WISH_TICKS = 20


def main() -> None:
    arguments = _arguments()
    scene = make_home(arguments.seed)
    report = measure(scene, arguments.seconds)
    if arguments.json:
        sys.stdout.write(json.dumps(report, indent=2) + "\n")
        return
    for name in ("compound", "compound_with_legs", "separate"):
        row = report[name]
        sys.stdout.write(f"{name:18} {row['real_time_factor']:7.1f} x real time  {row['us_per_step']:7.1f} us a step\n")
    sys.stdout.write(f"{report['speed_up']:.1f} times faster\n")


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", action="store_true", help="machine-readable report")
    parser.add_argument("--seed", type=int, default=1, help="the home's seed")
    parser.add_argument("--seconds", type=float, default=20.0, help="simulated seconds of each variant")
    return parser.parse_args()


def measure(scene: Scene, seconds: float) -> dict[str, Any]:
    """Both variants on one scene: CPU time a step, real-time factor, and what the world holds."""
    small = sum(not is_furniture(body) for body in scene.bodies.values())
    physics = Physics(scene, _starts(scene))
    compound = _drive(physics.bullet, list(physics.robots.values()), physics.advance, seconds)
    physics.close()
    articulated = Physics(scene, _starts(scene), legs=True)
    legs = _drive(articulated.bullet, list(articulated.robots.values()), articulated.advance, seconds / 4.0)
    articulated.close()
    bullet, rovers, advance = _separate_world(scene)
    separate = _drive(bullet, rovers, advance, seconds)
    bullet.disconnect()
    return {
        "scene_seed": scene.seed,
        "furniture": len(scene.bodies) - small,
        "small_things": small,
        "wall_boxes": len(structure_boxes(scene)),
        "robots": len(rovers),
        "drones": 1,
        "physics_hz": round(1.0 / STEP_S),
        "simulated_s": seconds,
        "compound": compound,
        "compound_with_legs": legs,
        "separate": separate,
        "speed_up": round(separate["us_per_step"] / compound["us_per_step"], 2),
    }


def _starts(scene: Scene) -> list[RobotStart]:
    return [RobotStart(f"dog-{k + 1}", at_m, yaw_rad) for k, (at_m, yaw_rad) in enumerate(scene.robot_starts[:2])]


def _drive(bullet: Any, rovers: list[Rover], advance: Callable[[int], None], seconds: float) -> dict[str, float]:
    """Robots wander by seeded wishes, the drone hovers; returns CPU time."""
    random = Random(1)
    drone = _add_drone(bullet, rovers[0])
    ticks = round(seconds / (TICK_STEPS * STEP_S))
    began_s = process_time()
    for tick in range(ticks):
        if tick % NEW_WISH_TICKS == 0:
            for rover in rovers:
                rover.wish = Wish(random.uniform(0.0, 0.6), 0.0, random.uniform(-1.0, 1.0))
        for _ in range(TICK_STEPS // PUSH_EVERY):
            _hover(bullet, drone)
            advance(PUSH_EVERY)
    step_s = (process_time() - began_s) / (ticks * TICK_STEPS)
    return {"us_per_step": round(step_s * 1e6, 2), "real_time_factor": round(STEP_S / step_s, 1)}


def _add_drone(bullet: Any, beside: Rover) -> int:
    x, y = beside.motion().position_m
    shape = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=DRONE_HALF_M)
    drone: int = bullet.createMultiBody(
        DRONE_KG, shape, useMaximalCoordinates=1, basePosition=(x - 0.5, y, DRONE_HEIGHT_M)
    )
    bullet.setCollisionFilterGroupMask(drone, -1, FIRST_ROBOT << 4, EVERYTHING)
    bullet.changeDynamics(drone, -1, activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING)
    return drone


def _hover(bullet: Any, drone: int) -> None:
    """Read the state and set what holds the height."""
    (_, _, height_m), _ = bullet.getBasePositionAndOrientation(drone)
    rise = GRAVITY_MPS2 * STEP_S * (PUSH_EVERY + 1) / 2.0 + 4.0 * (DRONE_HEIGHT_M - height_m)
    bullet.resetBaseVelocity(drone, (0.0, 0.0, rise), (0.0, 0.0, 0.0))


def _separate_world(scene: Scene) -> tuple[Any, list[Rover], Callable[[int], None]]:
    """Everything its own body, nothing asleep."""
    bullet = open_bullet()
    floor = bullet.createMultiBody(0.0, bullet.createCollisionShape(bullet.GEOM_PLANE))
    bullet.setCollisionFilterGroupMask(floor, -1, FLOOR, LOOSE)
    furniture = [body_box(body) for body in scene.bodies.values() if is_furniture(body)]
    for box in structure_boxes(scene) + furniture:
        add_static_boxes(bullet, [box], STATIC, EVERYTHING & ~(STATIC | FLOOR))
    for body in scene.bodies.values():
        if not is_furniture(body):
            _add_awake(bullet, body_box(body).centre_m, body_box(body).half_m)
    rovers = [
        one_body_rover(bullet, start.id, start.position_m, start.yaw_rad, FIRST_ROBOT << k, EVERYTHING & ~FLOOR)
        for k, start in enumerate(_starts(scene))
    ]

    def advance(steps: int) -> None:
        for rover in rovers:
            rover.push(STEP_S, steps, GRAVITY_MPS2)
        for _ in range(steps):
            bullet.stepSimulation()

    return bullet, rovers, advance


def _add_awake(bullet: Any, centre_m: tuple[float, float, float], half_m: tuple[float, float, float]) -> None:
    shape = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=half_m)
    body = bullet.createMultiBody(0.3, shape, useMaximalCoordinates=1, basePosition=centre_m)
    bullet.setCollisionFilterGroupMask(body, -1, LOOSE, EVERYTHING)
    bullet.changeDynamics(body, -1, activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING)


if __name__ == "__main__":
    main()
