"""Go on from an exported network: the inverse of `sim.training.export`.

The file has the normalisation folded into the convolutions, so each batch norm is given the mean and the variance that
its own input has on some pictures, and the scale and shift that undo them: the same function, ready to learn on. The
folded filters are as large as it happened; brought to one norm, a step of the optimiser turns all of them alike.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path

import onnx
import torch
from onnx import numpy_helper
from torch import Tensor, nn

from sim.training.network import DetectorNetwork

FILTER_NORM = 2.0
"""About what filters that are followed by a batch norm have grown to in training."""


def resume(network: DetectorNetwork, path: Path, pictures: Sequence[Tensor]) -> None:
    """Give `network` the weights of an ONNX file; `pictures` are batches (N, 5, H, W) of what it learns from.

    Raises ValueError when the file is of another network.
    """
    network.eval()
    convolutions = _in_order(network, pictures[0][:1])
    weights = list(_exported(path))
    shapes = [tuple(c.weight.shape) for c, _ in convolutions]
    if [tuple(w.shape) for w, _ in weights] != shapes:
        raise ValueError(f"{path}: its convolutions are not those of this network")
    with torch.no_grad():
        for (convolution, norm), (weight, bias) in zip(convolutions, weights, strict=True):
            if norm is None:
                assert convolution.bias is not None
                convolution.weight.copy_(weight)
                convolution.bias.copy_(bias)
            else:
                grown = FILTER_NORM / weight.flatten(1).norm(dim=1).clamp_min(1e-6)
                convolution.weight.copy_(weight * grown[:, None, None, None])
                norm.running_mean.zero_()
                norm.running_var.fill_(1.0 - norm.eps)
                norm.weight.copy_(1.0 / grown)
                norm.bias.copy_(bias)
        for norm, (mean, variance) in _statistics(network, convolutions, pictures).items():
            deviation = torch.sqrt(variance + norm.eps)
            norm.running_mean.copy_(mean)
            norm.running_var.copy_(variance)
            norm.bias.add_(mean * norm.weight)
            norm.weight.mul_(deviation)
    network.train()


Pairs = list[tuple[nn.Conv2d, nn.BatchNorm2d | None]]


def _in_order(network: DetectorNetwork, picture: Tensor) -> Pairs:
    """Every convolution, and the batch norm that follows it, in the order in which they are computed."""
    found: list[nn.Module] = []
    kinds = (nn.Conv2d, nn.BatchNorm2d)
    hooks = [
        m.register_forward_hook(lambda module, _in, _out: found.append(module))
        for m in network.modules()
        if isinstance(m, kinds)
    ]
    with torch.no_grad():
        network(picture)
    for hook in hooks:
        hook.remove()
    pairs: Pairs = []
    for module in found:
        if isinstance(module, nn.Conv2d):
            pairs.append((module, None))
        elif isinstance(module, nn.BatchNorm2d):
            pairs[-1] = (pairs[-1][0], module)
    return pairs


def _exported(path: Path) -> Iterator[tuple[Tensor, Tensor]]:
    """(weight, bias) of every convolution of the file, in order."""
    graph = onnx.load(str(path)).graph
    values = {i.name: torch.from_numpy(numpy_helper.to_array(i).copy()) for i in graph.initializer}
    for node in graph.node:
        if node.op_type == "Conv":
            yield values[node.input[1]], values[node.input[2]]


def _statistics(
    network: DetectorNetwork, pairs: Pairs, pictures: Sequence[Tensor]
) -> dict[nn.BatchNorm2d, tuple[Tensor, Tensor]]:
    """Mean and variance of what goes into each batch norm, over all pictures."""
    sums: dict[nn.BatchNorm2d, list[tuple[Tensor, Tensor]]] = {norm: [] for _, norm in pairs if norm is not None}

    def note(norm: nn.Module, inputs: tuple[Tensor, ...], _out: Tensor) -> None:
        assert isinstance(norm, nn.BatchNorm2d)
        x = inputs[0].transpose(0, 1).flatten(1)
        sums[norm].append((x.mean(1), x.pow(2).mean(1)))

    hooks = [norm.register_forward_hook(note) for norm in sums]
    with torch.no_grad():
        for batch in pictures:
            network(batch)
    for hook in hooks:
        hook.remove()
    result = {}
    for norm, seen in sums.items():
        mean = torch.stack([m for m, _ in seen]).mean(0)
        square = torch.stack([s for _, s in seen]).mean(0)
        result[norm] = (mean, square - mean.pow(2))
    return result
