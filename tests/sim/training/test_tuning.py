"""The recipe from pictures to a model on a server, whole, on the smallest model of the class with random weights.

Without the extra `train` it is skipped; docs/tune-a-vision-model.md says how to run it. The server is the stand-in.
"""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
MISSING = [name for name in ("torch", "transformers", "peft") if importlib.util.find_spec(name) is None]
pytestmark = [
    pytest.mark.skipif(bool(MISSING), reason=f"install the extra `train`: there is no {', '.join(MISSING)}"),
    pytest.mark.filterwarnings("ignore"),  # those libraries announce changes of their own
    pytest.mark.timeout(900),
]


@pytest.fixture(scope="module")
def pictures(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Made by a process of its own: a renderer and torch bring two compilers that do not bear one another."""
    folder = tmp_path_factory.mktemp("set")
    command = [sys.executable, "-m", "sim.training.cubes.dataset", "21", "--seed", "7", "--out", str(folder)]
    subprocess.run(command, check=True, cwd=ROOT, capture_output=True)
    return folder


@pytest.fixture(scope="module")
def tiny(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from tests.sim.training.tiny_model import write_tiny

    return write_tiny(tmp_path_factory.mktemp("tiny"))


def test_only_the_answer_is_learnt_and_the_picture_has_its_tokens(pictures: Path, tiny: Path) -> None:
    import torch

    from sim.training.tuning.lessons import UNLEARNT, rows
    from sim.training.tuning.tune import load

    _, encoder, tokenizer, _ = load(str(tiny), torch.float32)
    row = rows(pictures, "train")[0]
    lesson = encoder.lesson(row)
    learnt = lesson["input_ids"][0][lesson["labels"][0] != UNLEARNT]
    assert tokenizer.decode(learnt) == f"{row.answer}<|im_end|>\n"
    assert int(lesson["mm_token_type_ids"].sum()) == (644 // 28) * (476 // 28), "both sides are multiples of 28"
    assert "The grid and its numbers are not part of the scene." in row.system


def test_from_a_set_to_a_model_that_a_server_shows_with_eyes(pictures: Path, tiny: Path, tmp_path: Path) -> None:
    import torch
    from safetensors.torch import load_file

    from sim.training.tuning.__main__ import golden_of
    from sim.training.tuning.lessons import rows
    from sim.training.tuning.publish import check, create, modelfile
    from sim.training.tuning.tune import Recipe, load, reply, save, tune
    from tests.ollama_double.brains import looks
    from tests.ollama_double.dials import Dials
    from tests.ollama_double.server import State, running

    model, encoder, tokenizer, images = load(str(tiny), torch.float32)
    lessons = rows(pictures, "train")[:1]
    merged, losses = tune(model, encoder, lessons, Recipe(rate=1e-2, epochs=40, gather=1))
    assert len(losses) == 40
    assert losses[-1] < 0.8 * losses[0], "it learns the one answer that it is shown"
    assert not [name for name, _ in merged.named_parameters() if "lora" in name]
    said = reply(merged, encoder, lessons[0], most_tokens=8)
    out = tmp_path / "merged"
    save(merged, tokenizer, images, out)
    before, after = (
        {k: v for f in folder.glob("*.safetensors") for k, v in load_file(f).items()} for folder in (tiny, out)
    )
    assert before.keys() == after.keys(), "the layout of the model that it came from"
    changed = [name for name in after if not torch.equal(before[name], after[name])]
    assert changed
    assert all("_proj." in name and "visual" not in name for name in changed), "few pictures leave the eyes alone"
    again, encoder_again, *_ = load(str(out), torch.float32)
    assert reply(again, encoder_again, lessons[0], most_tokens=8) == said
    assert modelfile(out).startswith("FROM .\nPARAMETER temperature 0\n")

    golden = golden_of(pictures)
    with running(State(looks.make(Dials()))) as host:
        assert create(host, "r2x-eyes", out) == "success"
        figures = check(host, "r2x-eyes", golden, (pictures / "pictures" / golden.file).read_bytes())
    assert figures["stand_in"] is True, "the golden picture was seen by the stand-in, not by the tiny model"


def test_a_model_without_eyes_and_one_that_sees_nothing_are_refused(pictures: Path, tmp_path: Path) -> None:
    from sim.training.tuning.__main__ import golden_of
    from sim.training.tuning.publish import PublishError, check, create
    from tests.ollama_double.at_hand import Says
    from tests.ollama_double.server import State, running

    golden = golden_of(pictures)
    picture = (pictures / "pictures" / golden.file).read_bytes()
    (tmp_path / "model.safetensors").write_bytes(b"no weights")
    with running(State(Says(json.dumps({"objects": [], "texts": []})))) as host:
        create(host, "blind", tmp_path)
        with pytest.raises(PublishError, match="blind cannot see: the server made a model without its projector"):
            check(host, "blind", golden, picture)
        (tmp_path / "config.json").write_text('{"vision_config": {}}')
        create(host, "dreamer", tmp_path)
        with pytest.raises(PublishError, match="dreamer finds 0 of"):
            check(host, "dreamer", golden, picture)
    with pytest.raises(PublishError, match="no model server answers"):
        create(host, "late", tmp_path)
    with pytest.raises(PublishError, match=r"holds no \.safetensors"):
        create(host, "empty", pictures)


def test_with_many_pictures_the_eyes_are_tuned_too(tiny: Path) -> None:
    import torch

    from sim.training.tuning.tune import EYES_FROM, load, targets

    model, *_ = load(str(tiny), torch.float32)
    few, many = targets(model, EYES_FROM - 1), targets(model, EYES_FROM)
    assert len(few) == 2 * 7
    assert set(many) > set(few)
    assert any("visual.blocks.0.attn.qkv" in name for name in many)
