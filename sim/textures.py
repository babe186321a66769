"""Surfaces of the simulated building: seeded procedural pictures that multiply a part's own colour."""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

LAYERS = 13
PLAIN, WOOD, TILE, CARPET, FABRIC, BRICK, MARBLE, METAL, SCREEN, PAGES, LEAVES, PLASTER, BOARD = range(LAYERS)
"""WOOD on a floor is planks; on a thing it is drawn as BOARD, whose grain follows the longer side of a face."""

SIDE_PX = 128

REPEAT_M = (1.0, 1.2, 1.2, 0.6, 0.25, 0.9, 1.5, 0.4, 0.0, 0.25, 0.5, 2.0, 1.2)
"""Metres of surface that one repeat covers, by layer; 0 stretches the picture once over each face."""

Image = NDArray[np.float64]


@lru_cache(maxsize=1)
def layers() -> NDArray[np.uint8]:
    """All surfaces as (layer, row, column, RGB); row 0 is the top of the picture."""
    rng = np.random.default_rng(20)
    grey = {
        PLAIN: np.ones((SIDE_PX, SIDE_PX)),
        WOOD: _wood(rng),
        TILE: _tile(rng),
        CARPET: 0.86 + 0.10 * _noise(rng, 1.0, 1.0) + 0.04 * _noise(rng, 6.0, 6.0),
        FABRIC: _fabric(rng),
        BRICK: _brick(rng),
        MARBLE: _marble(rng),
        METAL: 0.94 + 0.022 * _noise(rng, 24.0, 0.6),
        PAGES: _pages(rng),
        LEAVES: 0.75 + 0.25 * np.tanh(2.0 * _noise(rng, 3.0, 3.0)),
        BOARD: 0.90 + 0.04 * _noise(rng, 28.0, 0.8) + 0.025 * _noise(rng, 30.0, 4.0),
        PLASTER: 0.96 + 0.03 * _noise(rng, 10.0, 10.0) + 0.01 * _noise(rng, 1.0, 1.0),
    }
    stack = np.empty((LAYERS, SIDE_PX, SIDE_PX, 3))
    for layer, image in grey.items():
        stack[layer] = image[..., None]
    stack[SCREEN] = _screen()
    return (np.clip(stack, 0.0, 1.0) * 255.0).astype(np.uint8)


def _noise(rng: np.random.Generator, blur_x_px: float, blur_y_px: float) -> Image:
    """Smooth noise of unit deviation that repeats without a seam, clipped to two deviations."""
    fx, fy = np.fft.fftfreq(SIDE_PX)[None, :], np.fft.fftfreq(SIDE_PX)[:, None]
    low_pass = np.exp(-2.0 * np.pi**2 * ((fx * blur_x_px) ** 2 + (fy * blur_y_px) ** 2))
    smooth = np.fft.ifft2(np.fft.fft2(rng.standard_normal((SIDE_PX, SIDE_PX))) * low_pass).real
    normal: Image = np.clip((smooth - smooth.mean()) / smooth.std(), -2.0, 2.0)
    return normal


def _grid() -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    rows, columns = np.mgrid[0:SIDE_PX, 0:SIDE_PX]
    return rows, columns


def _wood(rng: np.random.Generator) -> Image:
    """Planks along x with grain, a shade of their own and dark seams, their ends staggered."""
    rows, columns = _grid()
    plank = rows // 16
    board = (columns + rng.integers(0, SIDE_PX, 8)[plank]) // 64 % 2
    shade = rng.uniform(0.80, 0.98, (8, 2))[plank, board]
    ends = np.diff(board, axis=1, append=board[:, :1]) != 0
    seam = np.where((rows % 16 == 0) | ends, 0.72, 1.0)
    planks: Image = (shade + 0.05 * _noise(rng, 20.0, 0.8)) * seam
    return planks


def _tile(rng: np.random.Generator) -> Image:
    rows, columns = _grid()
    shade = rng.uniform(0.90, 1.0, (4, 4))[rows // 32, columns // 32]
    grout = (rows % 32 < 2) | (columns % 32 < 2)
    return np.where(grout, 0.62, shade + 0.015 * _noise(rng, 4.0, 4.0))


def _fabric(rng: np.random.Generator) -> Image:
    rows, columns = _grid()
    weave = np.where((rows // 4 + columns // 4) % 2 == 0, 1.0, 0.90)
    return weave - 0.04 + 0.04 * _noise(rng, 1.0, 1.0)


def _brick(rng: np.random.Generator) -> Image:
    rows, columns = _grid()
    course = rows // 16
    along = (columns + 16 * (course % 2)) % SIDE_PX
    shade = rng.uniform(0.72, 0.95, (8, 4))[course, along // 32]
    mortar = (rows % 16 < 2) | (along % 32 < 2)
    return np.where(mortar, 1.0, shade + 0.04 * _noise(rng, 1.5, 1.5))


def _marble(rng: np.random.Generator) -> Image:
    rows, columns = _grid()
    phase = 2.0 * np.pi * (rows + columns) / SIDE_PX + 0.5 * _noise(rng, 16.0, 16.0) + 0.15 * _noise(rng, 4.0, 4.0)
    vein = np.exp(-9.0 * np.abs(np.sin(phase))) * (0.6 + 0.3 * _noise(rng, 10.0, 10.0))
    slab = (rows % 64 < 1) | (columns % 64 < 1)
    return np.where(slab, 0.75, 0.96 + 0.015 * _noise(rng, 12.0, 12.0) - 0.20 * vein)


def _pages(rng: np.random.Generator) -> Image:
    """Lines of words on paper."""
    rows, columns = _grid()
    line = rows // 8
    ragged = rng.integers(80, 120, 16)[line]
    word = rng.random((16, 32))[line, columns // 4] > 0.2
    ink = (rows % 8 > 3) & (columns > 8) & (columns < ragged) & word
    return np.where(ink, 0.45, 1.0)


def _screen() -> Image:
    """What television shows: sun over hills, a bright ball and a caption bar."""
    rows, columns = _grid()
    x, y = columns / SIDE_PX, rows / SIDE_PX
    picture = np.stack([0.25 + 0.6 * y, 0.55 + 0.25 * y, np.full_like(y, 0.98)], axis=-1)
    picture[np.hypot(x - 0.75, y - 0.22) < 0.12] = (1.0, 0.92, 0.25)
    picture[y > 0.52 + 0.10 * np.sin(7.0 * x + 0.6)] = (0.18, 0.62, 0.25)
    picture[y > 0.66 + 0.06 * np.sin(9.0 * x + 2.0)] = (0.42, 0.78, 0.22)
    picture[np.hypot(x - 0.34, y - 0.60) < 0.15] = (0.95, 0.22, 0.20)
    picture[np.hypot(x - 0.34, y - 0.60) < 0.06] = (1.0, 1.0, 1.0)
    picture[y > 0.86] = (0.12, 0.14, 0.50)
    picture[(y > 0.90) & (y < 0.95) & (x > 0.08) & (x < 0.7) & (columns // 5 % 4 > 0)] = (1.0, 1.0, 1.0)
    return picture
