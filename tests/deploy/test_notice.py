"""NOTICE names every package that a running mesh is made of, and none of them binds its user to the GPL."""

import re

import pytest

from deploy.notice import HEAD, NOTICE, ROOT, licence, table, written

PACKAGES = [line.split()[0] for line in table().splitlines()]


def test_the_notice_is_of_what_is_installed() -> None:
    assert written(NOTICE.read_text()) == NOTICE.read_text(), "`python -m deploy.notice` writes it anew"


def test_packages_of_packages_are_named_and_tools_of_developers_are_not() -> None:
    assert {"eclipse-zenoh", "pydantic-core", "pyarrow", "protobuf"} <= set(PACKAGES)
    assert not {"pytest", "mypy", "ortools"} & set(PACKAGES)


def test_what_stands_around_the_table_is_kept() -> None:
    old = f"Before\n\n{HEAD}gone 1.0 MIT\n\nAfter\n"
    assert written(old) == f"Before\n\n{HEAD}{table()}\nAfter\n"


def test_the_ground_stations_of_the_tests_are_installed_nowhere_else() -> None:
    for name in ("pyproject.toml", "requirements.lock", "NOTICE"):
        assert not re.search("mavproxy|dronekit", (ROOT / name).read_text(), re.IGNORECASE), name


@pytest.mark.parametrize("package", PACKAGES)
def test_no_package_is_under_the_gpl(package: str) -> None:
    assert licence(package) != "none stated"
    assert not re.search(r"\bA?GPL|(?<!Lesser )General Public", licence(package))
