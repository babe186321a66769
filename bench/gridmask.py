"""Figure 5 and Table II of the second paper, here: how far from the truth are places read with and without GridMask?

`python -m bench.gridmask [--pictures N] [--seed N] [--model NAME --host URL] [--weights NAME=DIR ...] [--json]`

The runs are: the embedded detector of cubes on pictures with the grid and without, the same with other weights, and a
vision model of an Ollama server on both, where one is named. All runs are shown, none is picked. The pictures are of
floors that nothing was trained on.
"""

import argparse
import json
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from devices.vision.cube_detector import CubeDetector
from devices.vision.gridmask import cell_m, fov_rad, grid_for
from devices.vision.lens import Image, Lens
from devices.vision.model_eyes import question
from devices.vision.picture import decode_jpeg, encode_jpeg
from devices.vision.prompt import BIRDS_EYE
from devices.vision.reply import ReplyError, Report, read
from planners.asking import Model
from planners.looking import answer
from sim.training.cubes.dataset import JPEG_QUALITY, Example, examples
from sim.training.cubes.score import Tally
from wire.messages.look import LookReply
from wire.planner_table import PlannerChoice

TEST_FLOOR = 5000
PAPER = {
    "400G-FT | GridMask": "0.15 cells median (as told in the text)",
    "base model": "1.89 cells mean (as told in the text)",
}
"""What the paper says in words; its Figure 5 has no numbers at its other bars."""
Look = Callable[[Example, Image, Tally], Report]


@dataclass(frozen=True)
class Run:
    """One row: who looks, at which pictures."""

    name: str
    gridded: bool
    stand_in: bool
    figures: dict[str, float | int | None]


def evaluate(looks: Sequence[tuple[str, Look]], pictures: int, seed: int, stand_ins: set[str]) -> list[Run]:
    """Every looker on the same pictures, with and without the grid; `stand_ins` names those that turn out to be none."""
    tallies = {(name, gridded): Tally() for name, _ in looks for gridded in (True, False)}
    for example, rgb in examples(pictures, TEST_FLOOR + seed, 1.0, ("test",)):
        shown = _as_sent(rgb)
        for name, look in looks:
            tally = tallies[name, example.gridded]
            began = time.perf_counter()
            report = look(example, shown, tally)
            tally.took_s.append(time.perf_counter() - began)
            tally.add(example, report)
    return [Run(name, gridded, name in stand_ins, tally.summary()) for (name, gridded), tally in tallies.items()]


def embedded(detector: CubeDetector) -> Look:
    """The detector, given the picture as it is."""
    return lambda example, rgb, tally: detector.report(rgb, example.lens)


def modelled(model: Model, stand_ins: set[str], name: str) -> Look:
    """A vision model, asked as cameras ask; a reply that cannot be used counts as having seen nothing."""

    def look(example: Example, rgb: Image, tally: Tally) -> Report:
        asked = question(rgb, example.lens, "bench", BIRDS_EYE, example.task)
        # The picture has its grid already, or is to have none.
        reply = answer(model, asked.model_copy(update={"picture": encode_jpeg(rgb, JPEG_QUALITY)}))
        if reply.call is not None:
            tally.prompt_tokens += reply.call.prompt_tokens
            tally.completion_tokens += reply.call.completion_tokens
            if reply.call.stand_in:
                stand_ins.add(name)
        return _usable(reply, example.lens, tally)

    return look


def _usable(reply: LookReply, lens: Lens, tally: Tally) -> Report:
    grid = grid_for(lens)
    try:
        if not reply.text:
            raise ReplyError(reply.reason)
        return read(reply.text, BIRDS_EYE, grid, cell_m(lens.position_enu_m[2], fov_rad(lens), grid.divisions))
    except ReplyError:
        tally.unusable += 1
        return Report(())


def _as_sent(rgb: Image) -> Image:
    """Every looker sees what a JPEG leaves of it."""
    return decode_jpeg(encode_jpeg(rgb, JPEG_QUALITY))


def table(runs: Sequence[Run]) -> str:
    """For people."""
    head = "| who looks | pictures | recall | name right | median cells | p90 | flat, m | corrected, m | s |"
    lines = [head, "|---" * 9 + "|"]
    for run in runs:
        f = run.figures
        name = f"{run.name} (stand-in, no model)" if run.stand_in else run.name
        cells = [f["recall"], f["identity_right"], f["deviation_cells_median"], f["deviation_cells_p90"]]
        cells += [f["flat_m_median"], f["corrected_m_median"], f["seconds_per_picture"]]
        shown = " | ".join("-" if v is None else f"{v:.3f}" for v in cells)
        lines.append(f"| {name} | {f['pictures']} {'with' if run.gridded else 'without'} grid | {shown} |")
    return "\n".join([*lines, *(f"The paper, {name}: {words}" for name, words in PAPER.items())])


def _open(name: str, host: str) -> Model:
    from planners.model import OllamaModel  # only who has a model needs the client

    model = OllamaModel(PlannerChoice(model=name, vision=name, host=host, num_ctx=4096, timeout_s=300.0))
    model.start()
    return model


def main() -> None:
    parser = argparse.ArgumentParser(description="Places read with and without GridMask, by whom there is.")
    parser.add_argument("--pictures", type=int, default=100, help="of each kind")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--model", default="", help="a vision model as `ollama list` names it, such as qwen2.5vl:7b")
    parser.add_argument("--host", default="", help="its server; OLLAMA_HOST, or this machine's, when left out")
    parser.add_argument(
        "--weights", action="append", default=[], metavar="NAME=DIR", help="other weights of the detector"
    )
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    looks = [("embedded", embedded(CubeDetector()))]
    for named in arguments.weights:
        name, _, folder = named.partition("=")
        if not (Path(folder) / "cube_finder.onnx").exists():
            parser.error(f"--weights {named}: {folder or 'nothing'} is no folder with cube_finder.onnx in it")
        looks.append((name, embedded(CubeDetector(Path(folder)))))
    stand_ins: set[str] = set()
    if arguments.model:
        looks.append((arguments.model, modelled(_open(arguments.model, arguments.host), stand_ins, arguments.model)))
    runs = evaluate(looks, arguments.pictures, arguments.seed, stand_ins)
    document: dict[str, Any] = {"runs": [vars(run) for run in runs], "paper": PAPER, "seed": arguments.seed}
    print(json.dumps(document, indent=1) if arguments.json else table(runs))


if __name__ == "__main__":
    main()
