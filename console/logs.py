"""What processes say: their log files, each line with its process's name before it."""

import itertools
import json
import time
from collections.abc import Iterator
from pathlib import Path

from rich.text import Text

from console.output import terminal

_COLOURS = ("cyan", "green", "yellow", "magenta", "blue", "red", "bright_cyan", "bright_green", "bright_yellow")


def show_logs(files: list[Path], follow: bool, lines: int, as_json: bool) -> None:
    """Print the last lines of every file and, when following, what is added until Ctrl-C.

    As JSON each line is an object with `process` and `line`.
    """
    width = max((len(f.stem) for f in files), default=0)
    styles = dict(zip((f.stem for f in files), itertools.cycle(_COLOURS), strict=False))

    def show(name: str, line: str) -> None:
        if as_json:
            print(json.dumps({"process": name, "line": line.rstrip("\n")}), flush=True)
            return
        terminal.print(Text.assemble((f"{name:>{width}} | ", styles[name]), line.rstrip("\n")))

    for file in files:
        for line in file.read_text(errors="replace").splitlines()[-lines:]:
            show(file.stem, line)
    if follow:
        for name, line in _follow(files):
            show(name, line)


def _follow(files: list[Path], poll_s: float = 0.2) -> Iterator[tuple[str, str]]:
    """Lines appended to any of the files. The log files are rotated by renaming: a shrunken one is read anew."""
    offsets = {f: f.stat().st_size for f in files}
    while True:
        for file, offset in offsets.items():
            size = file.stat().st_size if file.exists() else 0
            if size < offset:
                offset = 0
            if size > offset:
                with file.open(errors="replace") as stream:
                    stream.seek(offset)
                    chunk = stream.read()
                    offsets[file] = stream.tell()
                yield from ((file.stem, line) for line in chunk.splitlines())
            else:
                offsets[file] = offset
        time.sleep(poll_s)
