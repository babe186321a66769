"""The two networks that see cubes: one finds what is there, the other reads a letter. See `devices.vision.cube_layout`."""

from typing import cast

import torch
from torch import Tensor, nn
from torch.nn import functional

from devices.vision.cube_layout import KINDS, LETTERS
from sim.training.network import Residual, conv

WIDTHS = (16, 32, 56, 80)


class Finder(nn.Module):
    """(N, 3, H, W) -> (N, kinds + 2, H / 8, W / 8): heat of every kind, and where in its cell the middle is."""

    def __init__(self) -> None:
        super().__init__()
        w2, w4, w8, w16 = WIDTHS
        self.to8 = nn.Sequential(conv(3, w2, 2), conv(w2, w4, 2), Residual(w4), conv(w4, w8, 2), Residual(w8))
        self.to16 = nn.Sequential(conv(w8, w16, 2), Residual(w16), Residual(w16))
        self.up = nn.Conv2d(w16, w8, 1)
        self.head = nn.Sequential(conv(w8, w8), nn.Conv2d(w8, len(KINDS) + 2, 1))
        bias = cast(nn.Conv2d, self.head[-1]).bias
        assert bias is not None
        nn.init.zeros_(bias)
        bias.data[: len(KINDS)] = -4.0

    def forward(self, picture: Tensor) -> Tensor:
        x8 = self.to8(picture)
        x16 = functional.interpolate(self.up(self.to16(x8)), scale_factor=2.0, mode="nearest")
        return cast(Tensor, self.head(x8 + x16))


class Reader(nn.Module):
    """(N, 3, 48, 48) -> (N, 28): logits of the letters, then cosine and sine of the turn."""

    def __init__(self) -> None:
        super().__init__()
        self.body = nn.Sequential(
            conv(3, 20, 2),
            Residual(20),
            conv(20, 40, 2),
            Residual(40),
            conv(40, 64, 2),
            Residual(64),
            conv(64, 32, 1, 1),
        )
        self.head = nn.Sequential(nn.Linear(32 * 36, 96), nn.ReLU(inplace=True), nn.Linear(96, len(LETTERS) + 2))

    def forward(self, picture: Tensor) -> Tensor:
        return cast(Tensor, self.head(torch.flatten(self.body(picture), 1)))
