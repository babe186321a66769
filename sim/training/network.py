"""The detector's network: a small feature pyramid with two heads, see `devices.vision.layout` for what they say."""

from typing import cast

from torch import Tensor, nn
from torch.nn import functional

from devices.vision import layout

INPUT_CHANNELS = 5
WIDTHS = (16, 32, 64, 128, 160)
"""Channels at strides 2, 4, 8, 16 and 32."""


def conv(inputs: int, outputs: int, stride: int = 1, kernel: int = 3) -> nn.Sequential:
    return nn.Sequential(
        nn.Conv2d(inputs, outputs, kernel, stride, kernel // 2, bias=False),
        nn.BatchNorm2d(outputs),
        nn.ReLU(inplace=True),
    )


class Residual(nn.Module):
    """Two convolutions around a narrow waist, added to what came in."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.inner = conv(channels, channels // 2)
        self.outer = nn.Sequential(nn.Conv2d(channels // 2, channels, 3, 1, 1, bias=False), nn.BatchNorm2d(channels))

    def forward(self, x: Tensor) -> Tensor:
        return functional.relu(x + self.outer(self.inner(x)))


class DetectorNetwork(nn.Module):
    """(N, 5, H, W) -> one map for each of `layout.heads()`; H and W are multiples of 32."""

    def __init__(self) -> None:
        super().__init__()
        w2, w4, w8, w16, w32 = WIDTHS
        small, large = layout.heads()
        self.to2 = conv(INPUT_CHANNELS, w2, 2)
        self.to4 = nn.Sequential(conv(w2, w4, 2), Residual(w4))
        self.to8 = nn.Sequential(conv(w4, w8, 2), Residual(w8), Residual(w8))
        self.to16 = nn.Sequential(conv(w8, w16, 2), Residual(w16), Residual(w16))
        self.to32 = nn.Sequential(conv(w16, w32, 2), Residual(w32), Residual(w32))
        self.up16, self.up8, self.up4 = (nn.Conv2d(a, b, 1) for a, b in ((w32, w16), (w16, w8), (w8, w4)))
        self.mix16, self.mix8, self.mix4 = conv(w16, w16), conv(w8, w8), conv(w4, w4)
        self.small = nn.Sequential(conv(w4, 48, kernel=3), nn.Conv2d(48, small.channels, 1))
        self.large = nn.Sequential(conv(w8, 96, kernel=1), nn.Conv2d(96, large.channels, 1))
        for head in (self.small, self.large):
            bias = cast(nn.Conv2d, head[-1]).bias
            assert bias is not None
            nn.init.zeros_(bias)
            bias.data[layout.HEAT] = -4.0

    def forward(self, picture: Tensor) -> tuple[Tensor, Tensor]:
        x4 = self.to4(self.to2(picture))
        x8 = self.to8(x4)
        x16 = self.to16(x8)
        x32 = self.to32(x16)
        y16 = self.mix16(x16 + _double(self.up16(x32)))
        y8 = self.mix8(x8 + _double(self.up8(y16)))
        y4 = self.mix4(x4 + _double(self.up4(y8)))
        return self.small(y4), self.large(y8)


def _double(x: Tensor) -> Tensor:
    return functional.interpolate(x, scale_factor=2.0, mode="nearest")
