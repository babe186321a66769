"""The network as the ONNX file that devices run."""

import warnings
from pathlib import Path

import torch

from sim.training.network import INPUT_CHANNELS, DetectorNetwork


def export(network: DetectorNetwork, path: Path) -> None:
    """Write it for pictures of any size; normalisation is folded into the convolutions."""
    network.eval()
    partial = path.with_suffix(".part.onnx")
    free = {2: "height", 3: "width"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the exporter announces its own successor
        torch.onnx.export(
            network,
            (torch.zeros(1, INPUT_CHANNELS, 480, 640),),
            str(partial),
            input_names=["picture"],
            output_names=["small", "large"],
            dynamic_axes={"picture": free, "small": free, "large": free},
            opset_version=17,
            dynamo=False,
        )
    partial.rename(path)
