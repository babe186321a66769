"""How the simulated quadrotor flies, and how fast it is simulated.

`python -m sim.flight.bench --json [--png FILE] [--peer DIR]`: `DIR` is a checkout of gym-pybullet-drones, whose own hover
example is then run in the same process at the same rates of physics and control, the two taking turns.
"""

import argparse
import json
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib.util import find_spec
from math import dist, sqrt
from pathlib import Path
from statistics import median
from time import process_time
from typing import Any

from sim.bullet import STEP_S
from sim.flight.state import Trajectory, Vec3
from sim.flight.world import BareFloor

_SEEDS = range(5)
_TURNS = 3
_PEER_NEEDS = ("numpy", "scipy", "gymnasium", "PIL", "pkg_resources")
_COURSE: tuple[Vec3, ...] = ((0.0, 0.0, -2.0), (0.0, 5.0, -2.0), (5.0, 5.0, -4.0), (5.0, 0.0, -4.0), (0.0, 0.0, -2.0))
"""PX4's acceptance course for offboard flight, in NED metres."""


@dataclass
class Flight:
    """A vehicle in the air over the origin, and what it truly does from then on."""

    seed: int
    times_s: list[float] = field(default_factory=list)
    track_ned_m: list[Vec3] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.world = BareFloor(seed=self.seed)
        self.vehicle = self.world.vehicles[0]
        self.world.advance(1.0)
        self.vehicle.arm()
        self.go((0.0, 0.0, -2.0))
        self.world.advance(7.0)

    def go(self, position_ned_m: Vec3) -> None:
        self.vehicle.command(Trajectory(position_ned_m, heading_rad=0.0))

    def fly(self, span_s: float) -> None:
        """Note the true place twenty times a second."""
        for _ in range(round(span_s / 0.05)):
            self.world.advance(0.05)
            (east, north, up), _yaw = self.vehicle.true_pose()
            self.times_s.append(self.world.now_s)
            self.track_ned_m.append((north, east, -up))

    def end(self) -> Vec3:
        return self.track_ned_m[-1]


def hold_rms_m(seed: int) -> float:
    """Root mean square of the true distance to the place to be held, over a minute."""
    flight = Flight(seed)
    flight.fly(60.0)
    flight.world.close()
    return sqrt(sum(dist(p, (0.0, 0.0, -2.0)) ** 2 for p in flight.track_ned_m) / len(flight.track_ned_m))


def straight(seed: int) -> tuple[float, float]:
    """(overshoot of ten metres to the north as a part of them, error 8 s after the start in metres)."""
    flight = Flight(seed)
    flight.go((10.0, 0.0, -2.0))
    flight.fly(8.0)
    flight.world.close()
    return max(0.0, max(p[0] for p in flight.track_ned_m) - 10.0) / 10.0, dist(flight.end(), (10.0, 0.0, -2.0))


def course_m(seed: int) -> list[float]:
    """True distance to each point of the course 10 s after it was asked for."""
    flight = Flight(seed)
    errors = []
    for point in _COURSE:
        flight.go(point)
        flight.fly(10.0)
        errors.append(dist(flight.end(), point))
    flight.world.close()
    return errors


def landing_m(seed: int) -> float:
    """How far from the place below which it began to sink it comes to stand."""
    flight = Flight(seed)
    flight.vehicle.command(Trajectory((0.0, 0.0, None), (None, None, 0.5), heading_rad=0.0))
    flight.fly(8.0)
    flight.world.close()
    if not flight.vehicle.on_ground:
        raise RuntimeError(f"seed {seed}: still in the air 8 s after it was told to land")
    north, east, _ = flight.end()
    return sqrt(north * north + east * east)


def times_real_time(vehicles: int, span_s: float = 20.0) -> float:
    """Simulated seconds a second of one core, all hovering."""
    world = BareFloor(vehicles)
    world.advance(1.0)
    for vehicle in world.vehicles:
        vehicle.arm()
        n, e, _ = vehicle.estimate.position_ned_m
        vehicle.command(Trajectory((n, e, -1.5), heading_rad=0.0))
    world.advance(4.0)
    took_s = _cpu_s(lambda: world.advance(span_s))
    world.close()
    return span_s / took_s


def peer_times_real_time(checkout: Path, span_s: float = 5.0) -> float:
    """The hover example of gym-pybullet-drones without its window: physics and control at 240 Hz."""
    if str(checkout) not in sys.path:
        sys.path.insert(0, str(checkout))
    import numpy as np
    from gym_pybullet_drones.control.DSLPIDControl import DSLPIDControl
    from gym_pybullet_drones.envs.CtrlAviary import CtrlAviary
    from gym_pybullet_drones.utils.enums import DroneModel, Physics

    env = CtrlAviary(
        DroneModel.CF2X, 1, initial_xyzs=np.array([[0.0, 0.0, 1.0]]), physics=Physics.PYB, pyb_freq=240, ctrl_freq=240, gui=False,
        record=False, obstacles=False, user_debug_gui=False,
    )  # fmt: skip
    pilot, action = DSLPIDControl(DroneModel.CF2X), np.zeros((1, 4))
    env.reset()

    def fly() -> None:
        nonlocal action
        for _ in range(round(span_s / STEP_S)):
            state = env.step(action)[0]
            rpm, _, _ = pilot.computeControlFromState(STEP_S, state[0], np.array([0.0, 0.0, 1.0]))
            action = rpm.reshape(1, 4)

    took_s = _cpu_s(fly)
    env.close()
    return span_s / took_s


def _cpu_s(work: Callable[[], None]) -> float:
    began = process_time()
    work()
    return process_time() - began


def measure(peer: Path | None = None) -> dict[str, Any]:
    holds, straights = [hold_rms_m(seed) for seed in _SEEDS], [straight(seed) for seed in _SEEDS]
    courses, landings = [course_m(seed) for seed in _SEEDS], [landing_m(seed) for seed in _SEEDS]
    result: dict[str, Any] = {
        "seeds": len(_SEEDS),
        "hold_rms_m": {"worst": max(holds), "all": holds},
        "overshoot_of_10_m": {"worst": max(s[0] for s in straights), "all": [s[0] for s in straights]},
        "waypoint_error_m": {
            "worst": max(max(c) for c in courses),
            "all": courses,
            "ten_metres": [s[1] for s in straights],
        },
        "landing_error_m": {"worst": max(landings), "all": landings},
        "times_real_time": times_real_time(1),
        "times_real_time_10_vehicles": times_real_time(10, 5.0),
    }
    if peer is not None:
        turns = [(times_real_time(1, 5.0), peer_times_real_time(peer)) for _ in range(_TURNS)]
        result["peer_times_real_time"] = median(theirs for _, theirs in turns)
        result["over_peer"] = median(ours / theirs for ours, theirs in turns)
        result["over_peer_worst"] = min(ours / theirs for ours, theirs in turns)
    return result


def what_is_wrong(png: Path | None, peer: Path | None) -> str | None:
    """One sentence on arguments that cannot work; None when they can."""
    if png is not None and not png.parent.is_dir():
        return f"--png {png}: there is no folder {png.parent}"
    if png is not None and png.suffix.lower() != ".png":
        return f"--png {png}: the name of the picture must end in .png"
    if peer is None:
        return None
    if not (peer / "gym_pybullet_drones" / "envs").is_dir():
        return (
            f"--peer {peer}: not a checkout of gym-pybullet-drones, there is no folder gym_pybullet_drones/envs in it"
        )
    missing = [name for name in _PEER_NEEDS if find_spec(name) is None]
    if missing:
        return f"--peer {peer}: gym-pybullet-drones needs {', '.join(missing)}, not installed beside {sys.executable}"
    return None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--png", type=Path, help="plot the step responses there")
    parser.add_argument("--peer", type=Path, help="a checkout of gym-pybullet-drones to measure beside")
    arguments = parser.parse_args()
    wrong = what_is_wrong(arguments.png, arguments.peer)
    if wrong is not None:
        parser.error(wrong)
    if arguments.png is not None:
        from sim.flight.plot import draw_steps

        draw_steps(arguments.png)
    print(json.dumps(measure(arguments.peer), indent=2, sort_keys=True))


if __name__ == "__main__":
    main()
