"""Windows and targets: what the network is asked for is what was in the picture."""

import numpy as np
import pytest

from devices.vision import layout
from devices.vision.picture import encode_jpeg
from sim.training.batches import WHOLE_PX, WINDOW_PX, Sampler, clear_enough, cut_window
from sim.training.shards import Shard, read_shards, write_shard
from sim.training.targets import make_target

from .scene import LENS, draw


@pytest.fixture(scope="module")
def shard() -> Shard:
    picture, labels = draw()
    return Shard([encode_jpeg(picture.rgb)], [LENS], labels)


def test_shards_come_back_from_disk(shard: Shard, tmp_path) -> None:
    for number in range(2):
        write_shard(tmp_path / f"home-{number}.npz", shard)
    both = read_shards(list(tmp_path.glob("*.npz")))
    assert both.jpegs == shard.jpegs * 2
    assert both.lenses == shard.lenses * 2
    assert both.labels["frame"].tolist() == [0] * len(shard.labels) + [1] * len(shard.labels)


def test_a_window_moves_labels_with_its_pixels(shard: Shard) -> None:
    rgb = np.zeros((480, 640, 3), np.uint8)
    labels = shard.labels.copy()
    left, top = int(labels["box"][0][0]) - 10, max(0, int(labels["box"][0][1]) - 20)
    window = cut_window(rgb, LENS, labels, clear_enough(labels), (min(top, 480 - WINDOW_PX[0]), min(left, 320)))
    assert window.rgb.shape == (*WINDOW_PX, 3)
    moved = window.labels[window.labels["key"] == labels["key"][0]][0]
    shift = labels["centre"][0] - moved["centre"]
    assert tuple(shift) == (min(left, 320), min(top, 480 - WINDOW_PX[0]))
    assert np.all(window.labels["box"] >= 0.0)


def test_targets_say_where_each_thing_is(shard: Shard) -> None:
    labels = shard.labels
    found = 0
    for head in layout.heads():
        target = make_target(head, labels, labels[:0], (480, 640))
        for row, column in zip(*np.nonzero(target.heat == 1.0), strict=True):
            values = target.values[:, row, column]
            u = (column + 0.5) * head.stride_px + values[0] * layout.CENTRE_SCALE_PX
            v = (row + 0.5) * head.stride_px + values[1] * layout.CENTRE_SCALE_PX
            nearest = labels[np.argmin(np.hypot(labels["centre"][:, 0] - u, labels["centre"][:, 1] - v))]
            assert nearest["centre"] == pytest.approx((u, v), abs=1e-2)
            assert head.types[target.classes[row, column]] == layout.detector_types()[nearest["type"]]
            assert values[layout.HEIGHT - 1] == pytest.approx(nearest["position"][2])
            found += 1
    assert found == len(labels)


def test_what_may_be_missed_is_not_asked_for(shard: Shard) -> None:
    for head in layout.heads():
        target = make_target(head, shard.labels[:0], shard.labels, (480, 640))
        assert target.heat.max() == 0.0
        assert target.weight_heat.min() == 0.0


def test_whole_pictures_come_too(shard: Shard) -> None:
    sizes = {batch.pictures.shape for batch, _ in zip(Sampler(shard, 4, seed=1), range(12), strict=False)}
    assert sizes == {(4, 5, *WINDOW_PX), (1, 5, *WHOLE_PX)}


def test_the_same_seed_gives_the_same_batches(shard: Shard) -> None:
    one, two = (next(iter(Sampler(shard, 2, seed=5))) for _ in range(2))
    assert np.array_equal(one.pictures, two.pictures)
    assert np.array_equal(one.targets[0].values, two.targets[0].values)
    other = next(iter(Sampler(shard, 2, seed=6)))
    assert not np.array_equal(one.pictures, other.pictures)
