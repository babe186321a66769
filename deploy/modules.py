"""Whether the modules that a site's processes run are there."""

from difflib import get_close_matches
from importlib.util import find_spec
from pathlib import Path

from wire.site import Site

_TOPS = ("devices", "hub", "planners", "sim")


def missing_modules(site: Site) -> str:
    """A sentence when this machine is to run a module that it does not have; else nothing."""
    faults = [
        f"process {row.id}: there is no module {row.module}{_meant(row.module)}"
        for row in site.process
        if row.host == "localhost" and not _is_there(row.module)
    ]
    return "; ".join(faults)


def _is_there(module: str) -> bool:
    try:
        found = find_spec(module)
        return found is not None and (
            found.submodule_search_locations is None or find_spec(f"{module}.__main__") is not None
        )
    except (ModuleNotFoundError, ValueError):
        return False


def _meant(module: str) -> str:
    """The module of this name's kind that is nearest to it."""
    known = (name for top in _TOPS for folder in _folders(top) for name in _runnable(folder))
    close = get_close_matches(module, sorted(known), n=1)
    return f"; is {close[0]} meant?" if close else "; make it, or correct `module` in the site file"


def _folders(package: str) -> list[str]:
    found = find_spec(package)
    return list(found.submodule_search_locations or ()) if found is not None else []


def _runnable(folder: str) -> list[str]:
    """The packages at and under a folder that `python -m` can run, wherever this is asked from."""
    root = Path(folder).parent
    return [".".join(file.parent.relative_to(root).parts) for file in Path(folder).glob("**/__main__.py")]
