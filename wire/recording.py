"""A recording: one file that only grows, a length and a msgpack record after the other, whole up to the last record.

A process that is killed while it writes leaves half a record at the end; readers stop there, and a writer that carries
on cuts it off first.
"""

import struct
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import NamedTuple, Self

import msgpack

_LENGTH = struct.Struct(">I")
_MAGIC = b"r2x-recording-1\n"
MAX_RECORD_BYTES = 16_000_000


class RecordingError(ValueError):
    """A file that is no recording."""


class Record(NamedTuple):
    now_s: float
    key: str
    """Without the realm."""
    sender: str
    tick: int
    payload: bytes


class RecordingWriter:
    """Appends to a file as a context manager. Its `write` is what LoopbackMesh takes as a recorder."""

    def __init__(self, file: Path) -> None:
        self._path = file

    def __enter__(self) -> Self:
        whole = _whole_bytes(self._path) if self._path.exists() else 0
        self._file = self._path.open("ab", buffering=0)
        self._file.truncate(whole)
        if whole == 0:
            self._file.write(_MAGIC)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._file.close()

    def write(self, now_s: float, key: str, sender: str, tick: int, payload: bytes) -> None:
        body: bytes = msgpack.packb((now_s, key, sender, tick, payload))
        self._file.write(_LENGTH.pack(len(body)) + body)


def read_recording(file: Path) -> Iterator[Record]:
    """Every whole record, in the order of writing."""
    for _, body in _bodies(file):
        yield Record(*msgpack.unpackb(body, use_list=False))


def _whole_bytes(file: Path) -> int:
    end = len(_MAGIC) if file.stat().st_size else 0
    for end, _ in _bodies(file):  # noqa: B007 - the end of the last one
        pass
    return end


def _bodies(file: Path) -> Iterator[tuple[int, bytes]]:
    """(offset of the end, bytes) of every whole record."""
    with file.open("rb") as data:
        magic = data.read(len(_MAGIC))
        if not magic:
            return
        if magic != _MAGIC:
            raise RecordingError(f"{file} is no recording of a mesh; `python -m wire.recorder` makes one")
        while len(head := data.read(_LENGTH.size)) == _LENGTH.size:
            (length,) = _LENGTH.unpack(head)
            body = data.read(length) if length <= MAX_RECORD_BYTES else b""
            if len(body) < length:
                return
            yield data.tell(), body
