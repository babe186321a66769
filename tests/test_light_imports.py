"""No process imports what its role does not need: `sys.modules` of each, right after its imports."""

import subprocess
import sys
from pathlib import Path

import pytest

HEAVY = {"numpy", "cv2", "scipy", "pybullet", "moderngl", "rerun", "pyarrow", "torch", "onnx", "onnxruntime", "lark", "typer",
         "rich", "supervisor", "matplotlib", "ollama", "mavsdk", "pymavlink"}  # fmt: skip
MAY_IMPORT = {
    "wire.router": set(),
    "wire.recorder": set(),
    "hub": {"numpy"},
    "planners": {"lark", "rapidfuzz"},
    "devices.cctv": {"numpy", "cv2", "onnxruntime"},
    "devices.quadruped": {"numpy", "cv2", "onnxruntime"},
    "hub.view": {"numpy", "rerun", "pyarrow"},
    "sim": {"numpy", "cv2", "pybullet", "moderngl"},
}


@pytest.mark.parametrize("module", sorted(MAY_IMPORT))
def test_a_role_imports_only_what_it_needs(module: str) -> None:
    root = Path(__file__).resolve().parents[1]
    main = f"{module}.__main__" if (root / module.replace(".", "/") / "__main__.py").exists() else module
    code = f"import sys, {main}; print(*sorted(set(m.split('.')[0] for m in sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=root, timeout=60)
    assert done.returncode == 0, done.stderr
    assert set(done.stdout.split()) & HEAVY <= MAY_IMPORT[module]
