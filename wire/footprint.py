"""Keeps a process's resident memory to what it uses: few allocation arenas, and start-up's leavings given back."""

import ctypes
import gc
import mmap
import re
import time
from collections.abc import Callable, Iterator
from pathlib import Path

SETTLED_S = 5.0
"""So long after it began the loop no longer does what is done but once."""
_ARENAS = 2
"""glibc's default of eight per core holds on to memory for idle threads."""
_M_ARENA_MAX = -8
_RANGE = re.compile(r"([0-9a-f]+)-([0-9a-f]+) (\S{4}) \S+ \S+ (\d+) ")


def limit_arenas() -> None:
    """Before any thread is started, however the process came to be: an environment variable would be too late."""
    ctypes.CDLL(None).mallopt(_M_ARENA_MAX, _ARENAS)


def release_startup_memory() -> None:
    """Give back what imports used once, and keep the collector from walking what stays for good."""
    gc.collect()
    gc.freeze()
    libc = ctypes.CDLL(None)
    libc.malloc_trim(0)
    for start, length in untouched_files(Path("/proc/self/smaps").read_text()):
        libc.madvise(ctypes.c_void_p(start), ctypes.c_size_t(length), mmap.MADV_DONTNEED)


def untouched_files(smaps: str) -> Iterator[tuple[int, int]]:
    """(start, length) of the mappings that hold nothing but what stands in their file: code and constants.

    Whatever of them is used again comes back from the page cache. A page that was written, which the linker does to
    much that is read-only afterwards, is anonymous and would be lost: mappings with such a page are left alone.
    """
    start = length = 0
    for line in smaps.splitlines():
        if found := _RANGE.match(line):
            start, end = int(found[1], 16), int(found[2], 16)
            length = end - start if found[4] != "0" and found[3][1] == "-" and found[3][3] == "p" else 0
        elif line.startswith(("Anonymous:", "Swap:")) and line.split()[1] != "0":
            length = 0
        elif line.startswith("VmFlags:") and length:
            yield start, length


def settling(stopping: Callable[[], bool], after_s: float = SETTLED_S) -> Callable[[], bool]:
    """`stopping`, which the loop asks in every pass, and start-up's memory given back once more when it has settled."""
    due_s = time.monotonic() + after_s

    def check() -> bool:
        nonlocal due_s
        if time.monotonic() > due_s:
            due_s = float("inf")
            release_startup_memory()
        return stopping()

    return check
