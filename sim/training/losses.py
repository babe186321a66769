"""How wrong the network is: focal loss on the heat, absolute errors, cross entropies."""

import torch
from torch import Tensor
from torch.nn import functional

from devices.vision import layout
from sim.training.targets import Target

CENTRE_WEIGHT, SIZE_WEIGHT, HEIGHT_WEIGHT, BEHIND_WEIGHT, PROP_WEIGHT, CLASS_WEIGHT = 2.0, 0.3, 0.4, 0.7, 1.0, 1.0


def head_loss(output: Tensor, target: Target) -> dict[str, Tensor]:
    """Terms of one head, each a mean over the things in the batch."""
    output = output.float()
    weight = torch.from_numpy(target.weight)
    inside = weight > 0.0
    w = weight[inside]
    total = w.sum().clamp(min=1.0)
    said = output.permute(0, 2, 3, 1)[inside]  # (cells, channels)
    true = torch.from_numpy(target.values).permute(0, 2, 3, 1)[inside]  # channels after the heat

    def mean(errors: Tensor) -> Tensor:
        return (errors * w).sum() / total

    def absolute(channels: slice) -> Tensor:
        return (said[:, channels] - true[:, channels.start - 1 : channels.stop - 1]).abs().sum(dim=1)

    spread = said[:, layout.HEIGHT_SPREAD].clamp(-5.0, 1.0)
    height_error = (said[:, layout.HEIGHT] - true[:, layout.HEIGHT - 1]).abs()
    classes = torch.from_numpy(target.classes)[inside]
    return {
        "heat": _focal(output[:, layout.HEAT], target),
        "centre": CENTRE_WEIGHT * mean(absolute(layout.CENTRE)),
        "size": SIZE_WEIGHT * mean(absolute(layout.SIZE)),
        # A Laplace likelihood: the network says how far off it may be.
        "height": HEIGHT_WEIGHT * mean(height_error * torch.exp(-spread) + spread),
        "behind": BEHIND_WEIGHT * mean((said[:, layout.BEHIND] - true[:, layout.BEHIND - 1]).abs()),
        "props": PROP_WEIGHT * _props(said[:, layout.PROPS], true[:, layout.PROPS.start - 1 :], w),
        "class": CLASS_WEIGHT * mean(functional.cross_entropy(said[:, layout.CLASSES :], classes, reduction="none")),
    }


def _focal(logits: Tensor, target: Target) -> Tensor:
    """Of centre-point detectors: cells near a centre count less as mistakes, easy cells hardly count."""
    heat, counts = torch.from_numpy(target.heat), torch.from_numpy(target.weight_heat)
    positive = (heat == 1.0).float()
    p = torch.sigmoid(logits)
    hit = positive * (1.0 - p) ** 2 * functional.logsigmoid(logits)
    miss = (1.0 - positive) * (1.0 - heat) ** 4 * p**2 * functional.logsigmoid(-logits)
    return -((hit + miss) * counts).sum() / positive.sum().clamp(min=1.0)


def _props(logits: Tensor, values: Tensor, weight: Tensor) -> Tensor:
    known = (values >= 0.0).float() * weight[:, None]
    errors = functional.binary_cross_entropy_with_logits(logits, values.clamp(min=0.0), reduction="none")
    return (errors * known).sum() / known.sum().clamp(min=1.0)
