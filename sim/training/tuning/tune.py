"""LoRA on a Qwen2.5-VL model, merged into a plain checkpoint that servers can read."""

import logging
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch
import transformers
from peft import LoraConfig, get_peft_model
from transformers import AutoTokenizer, Qwen2_5_VLForConditionalGeneration

from sim.training.tuning.lessons import Encoder, Row, epochs

log = logging.getLogger("tuning")

ImageProcessor = getattr(transformers, "Qwen2VLImageProcessorPil", transformers.Qwen2VLImageProcessor)
"""The one that needs no torchvision, where there are two."""
LANGUAGE = ("q_proj", "k_proj", "v_proj", "o_proj", "gate_proj", "up_proj", "down_proj")
EYES_FROM = 400
"""With so many pictures the layers that see are tuned, too; fewer would spoil them."""


@dataclass(frozen=True)
class Recipe:
    """What differs from one tuning to another."""

    rank: int = 16
    alpha: int = 16
    rate: float = 1e-4
    epochs: int = 3
    gather: int = 8
    """Conversations for one step of the optimiser."""
    seed: int = 1
    steps: int | None = None
    """Ends after so many conversations; None: all of all epochs."""


def load(source: str, dtype: torch.dtype) -> tuple[Any, Encoder, Any, Any]:
    """Model, encoder, tokenizer and image processor, from a folder or a name."""
    model = Qwen2_5_VLForConditionalGeneration.from_pretrained(source, dtype=dtype)
    tokenizer, images = AutoTokenizer.from_pretrained(source), ImageProcessor.from_pretrained(source)
    return model, Encoder(tokenizer, images), tokenizer, images


def targets(model: Any, pictures: int) -> list[str]:
    """Names of the layers that get an adapter: those of the language, and with enough pictures those that see."""
    return [
        name
        for name, module in model.named_modules()
        if isinstance(module, torch.nn.Linear)
        and (
            (".language_model." in name and name.endswith(LANGUAGE))
            or (".visual." in name and pictures >= EYES_FROM and not name.endswith("patch_embed.proj"))
        )
    ]


def tune(model: Any, encoder: Encoder, lessons: list[Row], recipe: Recipe) -> tuple[Any, list[float]]:
    """The merged model, and the loss of every conversation in turn."""
    torch.manual_seed(recipe.seed)
    config = LoraConfig(
        r=recipe.rank, lora_alpha=recipe.alpha, lora_dropout=0.0, target_modules=targets(model, len(lessons))
    )
    adapted = get_peft_model(model, config)
    learnt = [p for p in adapted.parameters() if p.requires_grad]
    optimiser = torch.optim.AdamW(learnt, recipe.rate, weight_decay=0.0)
    device = next(adapted.parameters()).device
    adapted.train()
    losses: list[float] = []
    began_s = time.monotonic()
    for number, row in enumerate(epochs(lessons, recipe.epochs, recipe.seed), 1):
        batch = {name: value.to(device) for name, value in encoder.lesson(row).items()}
        loss = adapted(**batch).loss
        (loss / recipe.gather).backward()
        losses.append(float(loss.detach()))
        last = number == recipe.steps or number == len(lessons) * recipe.epochs
        if number % recipe.gather == 0 or last:
            torch.nn.utils.clip_grad_norm_(learnt, 1.0)
            optimiser.step()
            optimiser.zero_grad()
            log.info("%d conversations, loss %.3f, %.0f s", number, losses[-1], time.monotonic() - began_s)
        if last:
            break
    return adapted.merge_and_unload(), losses


def save(model: Any, tokenizer: Any, images: Any, folder: Path) -> None:
    """A checkpoint without adapters, in the layout of the model that it came from."""
    folder.mkdir(parents=True, exist_ok=True)
    for part in (model, tokenizer, images):
        part.save_pretrained(folder)


@torch.no_grad()
def reply(model: Any, encoder: Encoder, row: Row, most_tokens: int = 512) -> str:
    """What the model answers to a conversation's beginning, the likeliest token each time."""
    model.eval()
    device = next(model.parameters()).device
    batch = {name: value.to(device) for name, value in encoder.prompt(row).items()}
    written = model.generate(**batch, max_new_tokens=most_tokens, do_sample=False)
    return encoder.text(written[0, batch["input_ids"].shape[1] :])
