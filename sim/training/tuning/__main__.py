"""From a labelled set to a model on a server: `python -m sim.training.tuning --set DIR --base MODEL --out DIR`."""

import argparse
import logging
from pathlib import Path

import torch

from sim.training.cubes.dataset import Example, read_labels
from sim.training.tuning.lessons import rows
from sim.training.tuning.publish import PublishError, check, create, modelfile
from sim.training.tuning.tune import Recipe, load, save, tune

log = logging.getLogger("tuning")


def main() -> None:
    parser = argparse.ArgumentParser(description="Tune a Qwen2.5-VL model on a set made by gridmask-data.")
    parser.add_argument("--set", type=Path, required=True, help="made by gridmask-data")
    parser.add_argument("--base", default="Qwen/Qwen2.5-VL-3B-Instruct", help="a folder, or a name on the model hub")
    parser.add_argument("--out", type=Path, required=True, help="folder for the merged checkpoint and its Modelfile")
    parser.add_argument("--epochs", type=int, default=Recipe.epochs)
    parser.add_argument("--rate", type=float, default=Recipe.rate)
    parser.add_argument("--steps", type=int, help="end after so many conversations")
    parser.add_argument("--create", metavar="NAME", help="make a model of it on the server, and check it")
    parser.add_argument("--host", default="http://127.0.0.1:11434", help="the Ollama server")
    parser.add_argument("--quantize", default="", help="such as q4_K_M; as it is when left out")
    arguments = parser.parse_args()
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    dtype = torch.bfloat16 if torch.cuda.is_available() else torch.float32
    model, encoder, tokenizer, images = load(arguments.base, dtype)
    if torch.cuda.is_available():
        model = model.to("cuda")
    lessons = rows(arguments.set, "train")
    recipe = Recipe(epochs=arguments.epochs, rate=arguments.rate, steps=arguments.steps)
    merged, losses = tune(model, encoder, lessons, recipe)
    save(merged, tokenizer, images, arguments.out)
    (arguments.out / "Modelfile").write_text(modelfile(arguments.out))
    log.info("loss %.3f at first, %.3f at last; the merged checkpoint is in %s", losses[0], losses[-1], arguments.out)
    if arguments.create:
        golden = golden_of(arguments.set)
        try:
            create(arguments.host, arguments.create, arguments.out, arguments.quantize)
            picture = (arguments.set / "pictures" / golden.file).read_bytes()
            log.info("%s: %s", arguments.create, check(arguments.host, arguments.create, golden, picture))
        except PublishError as error:
            parser.exit(1, f"{error}\n")


def golden_of(folder: Path) -> Example:
    """The first picture with a grid of the test split."""
    return next(e for e in read_labels(folder) if e.split == "test" and e.gridded)


if __name__ == "__main__":
    main()
