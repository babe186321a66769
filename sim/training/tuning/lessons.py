"""Rows of a set's `chat.jsonl` as what the model is trained on: tokens, pixels, and which tokens are the answer."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch
from PIL import Image
from torch import Tensor

IMAGE, VISION = "<|image_pad|>", ("<|vision_start|>", "<|vision_end|>")
START, END = "<|im_start|>", "<|im_end|>"
UNLEARNT = -100
"""Label of tokens that are read and not written."""


@dataclass(frozen=True)
class Row:
    """One conversation."""

    system: str
    user: str
    answer: str
    picture: Path


def rows(folder: Path, split: str) -> list[Row]:
    """Those of one split of a set made by `gridmask-data`."""
    found = []
    for line in (folder / "chat.jsonl").read_text().splitlines():
        row = json.loads(line)
        if row["split"] == split:
            system, user, answer = (message["content"] for message in row["messages"])
            found.append(Row(system[0]["text"], user[1]["text"], answer[0]["text"], folder / user[0]["image"]))
    return found


class Encoder:
    """Tokens and pixels of a conversation, for one model's tokenizer and image processor.

    Both sides of the picture become multiples of 28 pixels, the nearest to what they were (640x480: 644x476), here and
    in the server. Places are given in cells and not in pixels, so that this shifts nothing.
    """

    def __init__(self, tokenizer: Any, images: Any) -> None:
        self._tokenizer, self._images = tokenizer, images

    def lesson(self, row: Row) -> dict[str, Tensor]:
        """All of it, with the answer as labels."""
        batch = self.prompt(row)
        answer = self._ids(f"{row.answer}{END}\n")
        read = batch["input_ids"]
        batch["input_ids"] = torch.cat([read, answer], dim=1)
        batch["labels"] = torch.cat([torch.full_like(read, UNLEARNT), answer], dim=1)
        batch["attention_mask"] = torch.ones_like(batch["input_ids"])
        batch["mm_token_type_ids"] = self._kinds(batch["input_ids"])
        return batch

    def prompt(self, row: Row) -> dict[str, Tensor]:
        """What comes before the answer."""
        with Image.open(row.picture) as picture:
            pixels = self._images(images=[picture.convert("RGB")], return_tensors="pt")
        merged = self._images.merge_size**2
        count = int(pixels["image_grid_thw"][0].prod()) // merged
        seen = f"{VISION[0]}{IMAGE * count}{VISION[1]}"
        text = f"{START}system\n{row.system}{END}\n{START}user\n{seen}{row.user}{END}\n{START}assistant\n"
        ids = self._ids(text)
        return {
            "input_ids": ids,
            "attention_mask": torch.ones_like(ids),
            "mm_token_type_ids": self._kinds(ids),
            "pixel_values": pixels["pixel_values"],
            "image_grid_thw": pixels["image_grid_thw"],
        }

    def text(self, ids: Tensor) -> str:
        """What the model wrote."""
        return str(self._tokenizer.decode(ids, skip_special_tokens=True))

    def _ids(self, text: str) -> Tensor:
        return torch.tensor([self._tokenizer.encode(text, add_special_tokens=False)])

    def _kinds(self, ids: Tensor) -> Tensor:
        """1 where a token stands for a piece of the picture."""
        return (ids == self._tokenizer.convert_tokens_to_ids(IMAGE)).long()


def epochs(lessons: list[Row], count: int, seed: int) -> Iterator[Row]:
    """Every row once in each epoch, in another order each time."""
    chance = torch.Generator().manual_seed(seed)
    for _ in range(count):
        for number in torch.randperm(len(lessons), generator=chance).tolist():
            yield lessons[number]
