"""The Rerun viewer as a child process: without its telemetry, and silent unless something is wrong."""

import json
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path


def rerun_program() -> str:
    """The viewer itself. The script of its name only starts it, and leaves it behind when it is ended."""
    package = find_spec("rerun_cli")
    folders = list(package.submodule_search_locations or ()) if package is not None else []
    return str(Path(folders[0]) / "rerun") if folders else "rerun"


@contextmanager
def quiet_environment() -> Iterator[dict[str, str]]:
    """An environment in which Rerun phones nobody. Its only switch for that is a file in the configuration folder."""
    with tempfile.TemporaryDirectory(prefix="r2x-viewer-") as folder:
        file = Path(folder) / "rerun" / "analytics.json"
        file.parent.mkdir()
        told = {
            "analytics_enabled": False,
            "analytics_id": "",
            "metadata": {},
            "config_file_path": str(file),
            "data_dir_path": str(file.parent),
        }
        file.write_text(json.dumps(told))
        without = ("FORCE_RERUN_ANALYTICS", "RERUN_TELEMETRY_ENDPOINT", "TELEMETRY_ENABLED")
        mine = {name: value for name, value in os.environ.items() if name not in without}
        yield {**mine, "XDG_CONFIG_HOME": folder, "RUST_LOG": "error"}
