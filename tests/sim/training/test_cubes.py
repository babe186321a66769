"""Cubes seen from above: letters, scenes, sets and the score, all from their seeds."""

import json
from math import dist
from pathlib import Path

import numpy as np
import pytest

from devices.vision.cube_layout import LETTERS, STRIDE_PX, crop, finder_picture, padded
from devices.vision.gridmask import cell_m, cells_of, fov_rad, grid_for, place_m
from devices.vision.picture import decode_jpeg
from devices.vision.prompt import BIRDS_EYE, COLOUR_CUBES, LETTER_CUBES
from devices.vision.reply import Entry, Report, read
from sim.training.cubes import dataset
from sim.training.cubes.dataset import Example, answer_of, conversation, examples, read_labels, split_of, write_set
from sim.training.cubes.glyphs import LETTERS as GLYPHS
from sim.training.cubes.glyphs import strokes
from sim.training.cubes.models import COLOURS, EDGE_M
from sim.training.cubes.scenes import CubeStudio
from sim.training.cubes.score import Tally


@pytest.fixture(scope="module")
def few() -> list[tuple[Example, np.ndarray]]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(dataset, "SHOTS_A_FLOOR", 2)
        return list(examples(5, seed=7))


def test_every_letter_and_colour_has_a_cube() -> None:
    assert sorted(GLYPHS) == list(LETTERS)
    assert [f"cube_{c}" for c in sorted(COLOURS)] == sorted(COLOUR_CUBES)
    assert len(LETTER_CUBES) == 26
    for letter in GLYPHS:
        points = [p for stroke in strokes(letter) for p in stroke]
        assert all(-0.1 <= x <= 1.1 and -0.1 <= y <= 1.05 for x, y in points)


def test_equal_seeds_make_equal_pictures() -> None:
    first, second = CubeStudio(3), CubeStudio(3)
    for _ in range(2):
        a, b = first.shoot(), second.shoot()
        assert a.truths == b.truths
        assert a.lens == b.lens
        assert (a.rgb == b.rgb).all()
    first.close()
    second.close()


def test_a_coloured_cube_is_where_the_truth_says() -> None:
    studio, found = CubeStudio(12), 0
    for _ in range(4):
        shot = studio.shoot()
        for truth in shot.truths:
            if truth.name in ("cube_red", "cube_blue", "cube_green"):
                u, v = shot.lens.pixels(truth.point_m)[0, :2].astype(int)
                channel = ("cube_red", "cube_green", "cube_blue").index(truth.name)
                assert shot.rgb[v - 2 : v + 3, u - 2 : u + 3].mean(axis=(0, 1)).argmax() == channel
                found += 1
    studio.close()
    assert found


def test_twins_and_splits(few: list[tuple[Example, np.ndarray]]) -> None:
    gridded = [e for e, _ in few if e.gridded]
    plain = [(e, rgb) for e, rgb in few if not e.gridded]
    assert [e.split for e in gridded] == ["train", "train", "validation", "validation", "test"]
    assert [e.file for e, _ in plain] == ["00004_plain.jpg"]
    (with_grid,) = (rgb for e, rgb in few if e.file == "00004.jpg")
    assert (with_grid[:, 320] == (235, 40, 40)).all(axis=1).mean() > 0.9
    assert (with_grid != plain[0][1]).any(axis=2).mean() < 0.3
    assert {split_of(floor) for floor in range(100)} == {"train", "validation", "test"}


def test_twenty_of_a_hundred_have_a_twin(monkeypatch: pytest.MonkeyPatch) -> None:
    pairs = [n for n in range(200) if (n * dataset.TWINS) % 1.0 + dataset.TWINS >= 1.0 - 1e-9]
    assert len(pairs) == 40


def test_the_right_answer_is_read_whole_and_leads_back_to_the_truth(few: list[tuple[Example, np.ndarray]]) -> None:
    for example, _ in few:
        grid = grid_for(example.lens)
        length_m = cell_m(example.lens.position_enu_m[2], fov_rad(example.lens), grid.divisions)
        report = read(answer_of(example), BIRDS_EYE, grid, length_m)
        assert report.doubts == ()
        assert len(report.entries) == len(example.labels)
        for entry, label in zip(report.entries, example.labels, strict=True):
            place = place_m(grid, example.lens, entry.x_cells, entry.y_cells, label.point_m[2])
            assert place is not None
            assert dist(place, label.point_m) < 0.01, "two decimals of a cell are four millimetres"
        heights = [label.y_cells for label in example.labels]
        assert heights == sorted(heights, reverse=True)


def test_a_set_on_disk_is_what_cameras_ask(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dataset, "SHOTS_A_FLOOR", 1)
    counts = write_set(2, tmp_path, seed=8, twins=0.5)
    assert counts == {"validation, with grid": 1, "test, with grid": 1, "test, without grid": 1}
    chat = [json.loads(line) for line in (tmp_path / "chat.jsonl").read_text().splitlines()]
    labels = read_labels(tmp_path)
    assert [json.loads(json.dumps(conversation(e))) for e in labels] == chat
    for example in labels:
        assert decode_jpeg((tmp_path / "pictures" / example.file).read_bytes()).shape == (480, 640, 3)


def test_a_crop_has_one_scale_at_every_height(few: list[tuple[Example, np.ndarray]]) -> None:
    for example, rgb in few:
        small = finder_picture(rgb, example.lens)
        edge_px = example.lens.focal_px * EDGE_M / (example.lens.position_enu_m[2] - EDGE_M)
        assert edge_px * small.shape[1] / rgb.shape[1] == pytest.approx(25.0, abs=0.5)
        assert all(side % 32 == 0 for side in padded(small).shape[:2])
        assert crop(rgb, example.lens, 320.0, 240.0).shape == (48, 48, 3)
    assert STRIDE_PX == 8


def test_the_score_of_the_truth_is_perfect_and_of_errors_what_they_are(few: list[tuple[Example, np.ndarray]]) -> None:
    example = max((e for e, _ in few), key=lambda e: len(e.labels))
    entries = [
        Entry(b.name, b.x_cells, b.y_cells, None if b.yaw_deg is None else np.radians(b.yaw_deg), None, b.part)
        for b in example.labels
    ]
    perfect, shifted, misnamed = Tally(), Tally(), Tally()
    perfect.add(example, Report(tuple(entries)))
    assert perfect.summary()["recall"] == 1.0
    assert perfect.summary()["deviation_cells_median"] == 0.0
    assert (perfect.summary()["corrected_m_median"] or 0.0) < 0.005
    shifted.add(example, Report(tuple(Entry(e.name, e.x_cells + 0.3, e.y_cells, None, None, e.part) for e in entries)))
    assert shifted.summary()["deviation_cells_median"] == pytest.approx(0.3)
    cubes = [e for e in entries if e.part is None]
    misnamed.add(
        example,
        Report(tuple(Entry("cube_red" if e.name != "cube_red" else "cube_blue", e.x_cells, e.y_cells) for e in cubes)),
    )
    assert misnamed.found + misnamed.misnamed <= len(cubes)
    assert misnamed.misnamed >= len(cubes) - 2
    empty = Tally()
    empty.add(example, Report(()))
    assert (empty.summary()["recall"], empty.summary()["deviation_cells_median"]) == (0.0, None)


def test_flat_places_are_worse_than_corrected_ones(few: list[tuple[Example, np.ndarray]]) -> None:
    tally = Tally()
    for example, _ in few:
        grid = grid_for(example.lens)
        at = [cells_of(grid, example.lens, b.point_m) for b in example.labels]
        tally.add(
            example,
            Report(tuple(Entry(b.name, *p, None, None, b.part) for b, p in zip(example.labels, at, strict=True) if p)),
        )
    assert np.median(tally.flat_m) > 5.0 * np.median(tally.corrected_m)
