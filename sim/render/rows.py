"""One drawn primitive as a row of numbers."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

ROW = np.dtype(
    [
        ("axes", np.float32, (3, 3)),
        ("centre", np.float32, 3),
        ("rgb", np.float32, 3),
        ("surface", np.float32),
        ("emission", np.float32),
        ("room", np.float32),
        ("id", np.int32),
        ("shape", np.int32),
        ("rooms", np.uint64),
    ]
)
"""`axes`: its local x, y, z in the site frame, as long as its sides. `room`: whose lamp lights it. `rooms`: one bit
for each room it can be seen from. The fields up to `id` are what a graphics card needs."""

Rows = NDArray[Any]
EVERYWHERE = np.uint64(0xFFFFFFFFFFFFFFFF)
