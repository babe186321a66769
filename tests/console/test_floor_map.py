"""The floor plan as a picture: what a camera cannot see is not painted as seen, and names stay apart."""

from math import inf
from pathlib import Path

import cv2
import pytest

from console.floor_map import FloorMap, wall_m
from tests.hub.scenes import flat
from wire.site import Camera, Wall


@pytest.mark.parametrize(
    ("towards", "met_m"), [((1.0, 0.0), 2.0), ((-1.0, 0.0), inf), ((0.0, 1.0), inf), ((0.6, 0.8), inf)]
)
def test_a_wall_is_met_where_it_stands(towards: tuple[float, float], met_m: float) -> None:
    wall = Wall(start_m=(3.0, 0.0), end_m=(3.0, 2.0))
    assert wall_m((1.0, 1.0), towards, wall) == pytest.approx(met_m)


def test_no_camera_watches_what_is_behind_a_wall(tmp_path: Path) -> None:
    """A camera of the kitchen looks east at the wall at 4 m, below the door."""
    camera = Camera(
        id="cam-9", position_enu_m=(2.5, 0.7, 2.3), yaw_deg=0.0, tilt_down_deg=30.0,
        width_px=640, height_px=480, focal_px=1280.0,
    )  # fmt: skip

    def colours(cameras: tuple[Camera, ...]) -> tuple[list[int], list[int]]:
        picture = FloorMap(flat().model_copy(update={"camera": cameras}))
        picture.draw_house()
        picture.save(tmp_path / "map.png")
        bgr = cv2.imread(str(tmp_path / "map.png"))
        assert bgr is not None
        at = [(round((x + 0.6) * 70), round((4.6 - 0.7) * 70)) for x in (3.5, 4.6)]
        return bgr[at[0][1], at[0][0]].tolist(), bgr[at[1][1], at[1][0]].tolist()

    bare, watched = colours(()), colours((camera,))
    assert watched[0] != bare[0]
    assert watched[1] == bare[1]


def test_names_are_written_beside_each_other() -> None:
    picture = FloorMap(flat())
    for _ in range(4):
        picture._label("Television", (2.0, 2.0), 7, (60, 60, 60), 0.34)
    boxes = picture._taken
    assert all(a[2] < b[0] or b[2] < a[0] or a[3] < b[1] or b[3] < a[1] for i, a in enumerate(boxes) for b in boxes[:i])


def test_a_long_title_takes_more_lines_and_hides_nothing(tmp_path: Path) -> None:
    shapes = []
    for name, title in (("short", "turn off the TV"), ("long", "put the apple in the fridge and " * 20)):
        picture = FloorMap(flat())
        picture.draw_house()
        picture.draw_title(title)
        picture.save(tmp_path / f"{name}.png")
        shapes.append(cv2.imread(str(tmp_path / f"{name}.png")))
    short, long = shapes
    grown = long.shape[0] - short.shape[0]
    assert grown > 50
    assert (long[grown + 40 :] == short[40:]).all(), "the floor plan moved down as it was"
    assert (long[: grown + 30, -8:] == 255).all(), "no letter reaches the edge"
