"""What drones have truly been over."""

from sim.flight.state import Trajectory
from sim.overhead import Overhead
from sim.physics import Physics, RobotStart
from tests.sim.small_home import make_small_home


def test_hovering_over_a_room_counts_standing_in_it_does_not() -> None:
    scene = make_small_home()
    physics = Physics(scene, [], drones=[RobotStart("drone-1", (1.5, 2.0), 0.0)])
    over, drone = Overhead(scene), physics.drones["drone-1"]
    room = next(room.id for room in scene.rooms)

    def run(span_s: float) -> None:
        for _ in range(round(span_s / 0.5)):
            physics.advance(120)
            over.watch(physics.drones, physics.step_count / 240.0)

    run(2.0)
    assert not over.rooms
    assert not over.things
    drone.arm()
    drone.command(Trajectory((2.0, 1.5, -1.6)))
    run(6.0)
    assert over.rooms == {room}
    assert room not in over.surveyed, "a look at one spot is no survey"
    fly_over = sorted(over._cells[room])[::3]  # every spot from which the whole floor comes to be seen
    for x, y in fly_over:
        if 0.5 < x < 5.5 and 0.5 < y < 4.5:
            drone.command(Trajectory((y, x, -1.8)))
            run(2.0)
    assert room in over.surveyed
    physics.close()
