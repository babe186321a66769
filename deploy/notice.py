"""Writes the table of packages in NOTICE from what is installed: `python -m deploy.notice`.

Listed is what `requirements.lock` holds for the extra `all`, its licences as the packages' own metadata say them.
"""

import re
import tomllib
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
NOTICE = ROOT / "NOTICE"
HEAD = "package                  licence                            needed by\n"
_NAME = re.compile(r"([A-Za-z0-9._-]+)(?:\[([^]]*)\])?")
_LONGEST_LICENCE = 60
"""More than this in the field `License` is the licence itself."""


def written(notice: str) -> str:
    """The notice with its table as it should be; the table ends with the first empty line."""
    before, _, rest = notice.partition(HEAD)
    _, _, after = rest.partition("\n\n")
    return f"{before}{HEAD}{table()}\n{after}"


def table() -> str:
    """A line for each package: name, licence, and what brings it in: extras of R2X, or other packages."""
    rows = sorted(_needed().items())
    return "".join(f"{name:<24} {licence(name):<34} {', '.join(sorted(by))}\n" for name, by in rows)


def licence(package: str) -> str:
    """What a package says of itself: an SPDX expression where it has one, else its field, else its classifiers."""
    about = distribution(package).metadata
    fields: list[str] = about.get_all("License-Expression") or about.get_all("License") or []
    if fields and 0 < len(fields[0].strip()) <= _LONGEST_LICENCE:
        return fields[0].strip()
    classifiers: list[str] = about.get_all("Classifier") or []
    return " or ".join(c.rpartition(" :: ")[2] for c in classifiers if c.startswith("License ::")) or "none stated"


def _needed() -> dict[str, set[str]]:
    """Package -> who asks for it. Only what is locked counts: the lock is for this platform."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras: dict[str, list[str]] = project["optional-dependencies"]
    locked = set(re.findall(r"^([a-z0-9-]+)==", (ROOT / "requirements.lock").read_text(), re.M))
    asked = [(requirement, "R2X") for requirement in project["dependencies"]]
    asked += [(requirement, extra) for extra in _inner(extras["all"]) for requirement in extras[extra]]
    needed: dict[str, set[str]] = {}
    while asked:
        requirement, by = asked.pop()
        name, inner = _split(requirement)
        if name == "r2x":
            asked += [(more, extra) for extra in inner for more in extras[extra]]
        elif name in locked:
            if name not in needed:
                asked += [(more, name) for more in _required(name)]
            needed.setdefault(name, set()).add(by)
    return needed


def _required(package: str) -> list[str]:
    """Requirements of a package without its extras."""
    try:
        return [r for r in distribution(package).requires or () if "extra ==" not in r]
    except PackageNotFoundError:
        return []


def _inner(requirements: list[str]) -> list[str]:
    return [extra for requirement in requirements for extra in _split(requirement)[1]]


def _split(requirement: str) -> tuple[str, list[str]]:
    """Its normalised name and its extras."""
    match = _NAME.match(requirement)
    assert match is not None
    extras = [extra.strip() for extra in (match[2] or "").split(",") if extra.strip()]
    return re.sub(r"[-_.]+", "-", match[1]).lower(), extras


if __name__ == "__main__":
    NOTICE.write_text(written(NOTICE.read_text()))
