"""What a process gives back is what stands in files, and nothing of it is missed afterwards."""

import re
import subprocess
import sys
from pathlib import Path

from wire.footprint import untouched_files

ROOT = Path(__file__).parents[2]


def mapping(first: str, permissions: str, inode: int, anonymous_kb: int = 0, swap_kb: int = 0) -> str:
    end = f"{int(first, 16) + 0x1000:x}"
    return (
        f"{first}-{end} {permissions} 00000000 fe:00 {inode} {'/lib/one.so' if inode else ''}\n"
        f"Size:                  4 kB\nAnonymous:      {anonymous_kb} kB\nAnonHugePages:         0 kB\n"
        f"Swap:           {swap_kb} kB\nSwapPss:               0 kB\nVmFlags: rd ex mr\n"
    )


def test_only_what_stands_in_a_file_is_given_back() -> None:
    smaps = "".join([
        mapping("1000", "r-xp", 7),
        mapping("3000", "r--p", 7),
        mapping("5000", "r--p", 7, anonymous_kb=4),  # relocated by the linker, read-only since
        mapping("7000", "r--p", 7, swap_kb=4),
        mapping("9000", "rw-p", 7),
        mapping("b000", "r--s", 7),
        mapping("d000", "r-xp", 0),
        mapping("f000", "r-xp", 9),
    ])  # fmt: skip
    assert list(untouched_files(smaps)) == [(0x1000, 0x1000), (0x3000, 0x1000), (0xF000, 0x1000)]


def test_a_process_goes_on_with_less() -> None:
    code = """
import json, re, sqlite3
import cv2, msgpack, numpy as np, zenoh
from wire.footprint import limit_arenas, settling
from wire.messages.clock import Tick

def file_kb():
    return int(re.search(r"RssFile:\\s+(\\d+)", open("/proc/self/status").read())[1])

def use():
    picture = (np.arange(64 * 64 * 3) % 251).astype(np.uint8).reshape(64, 64, 3)
    words = [sqlite3.connect(":memory:").execute("SELECT 6 * 7").fetchone()[0], str(zenoh.KeyExpr("a/b"))]
    return [*words, len(cv2.imencode(".png", picture)[1]), float(np.linalg.det(np.eye(3) * 2)),
            Tick.model_validate(msgpack.unpackb(msgpack.packb({"tick": 1, "now_s": 1.0, "step_s": 0.1}))).tick]

limit_arenas()
before, full = use(), file_kb()
check = settling(lambda: False, after_s=0.0)
stopped, lean = check(), file_kb()
print(json.dumps([before == use(), stopped, full, lean]))
"""
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    same, stopped, full_kb, lean_kb = re.findall(r"\w+", done.stdout)
    assert (same, stopped) == ("true", "false")
    assert int(lean_kb) < 0.7 * int(full_kb)
