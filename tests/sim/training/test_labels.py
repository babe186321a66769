"""Labels: what the renderer's ids and the scene say of a picture."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from devices.vision import layout
from devices.vision.detector import Detection
from devices.vision.projection import at_depth, on_plane, surface_depth_m
from sim.training.labels import visible_boxes
from wire.catalogue import PROPS

from .scene import LENS, MUG, TABLE, TELEVISION, draw


@given(arrays(np.int32, (7, 9), elements=st.integers(-1, 4)))
def test_boxes_hold_every_pixel_of_their_id(ids: np.ndarray) -> None:
    found = {key: (box, count) for key, box, count in visible_boxes(ids)}
    assert sum(count for _, count in found.values()) == ids.size
    for key, (box, count) in found.items():
        rows, columns = np.nonzero(ids == key)
        assert box == (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1)
        assert count == len(rows)


def test_every_thing_is_labelled_with_its_state() -> None:
    _, labels = draw()
    types = layout.detector_types()
    rows = {int(row["key"]): row for row in labels}
    assert {key: types[row["type"]] for key, row in rows.items()} == {
        TABLE: "DiningTable",
        MUG: "Mug",
        TELEVISION: "Television",
    }
    assert dict(zip(PROPS, rows[MUG]["props"].tolist(), strict=True)) == {
        "isOpen": -1,
        "isToggled": -1,
        "isDirty": 1,
        "isSliced": -1,
    }
    assert rows[TELEVISION]["props"][PROPS.index("isToggled")] == 1


def test_labels_lead_back_to_where_things_are() -> None:
    picture, labels = draw()
    for row in labels:
        box = tuple(float(x) for x in row["box"])
        u, v = row["centre"].tolist()
        one = Detection("Mug", 1.0, u, v, box, float(row["position"][2]), 0.05, float(row["behind"]))
        ray = LENS.rays(u, v)[0]
        surface_m = surface_depth_m(one, picture.depth_m)
        assert surface_m is not None
        truth = tuple(row["position"].tolist())
        assert at_depth(one, ray, surface_m, LENS).position_enu_m == pytest.approx(truth, abs=1e-3)
        plane = on_plane(one, ray, LENS)
        assert plane is not None
        assert plane.position_enu_m == pytest.approx(truth, abs=1e-3)
