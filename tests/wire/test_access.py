"""The generated access control says what the tables say, and no more."""

from typing import Any

import pytest

from wire.access import access_control, devices_of, users_of
from wire.site import Process, Site, parse_site

SITE: dict[str, Any] = {
    "name": "test",
    "room": [{"id": "room", "name": "Room", "kind": "Other", "polygon_m": [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]}],
    "process": [
        {"id": id, "role": role, "module": "some.module"}
        for id, role in (
            ("router", "router"),
            ("sim", "sim"),
            ("hub", "hub"),
            ("planner", "planner"),
            ("view", "view"),
            ("cctv-1", "cctv"),
            ("cctv-2", "cctv"),
            ("dog-1", "robot"),
            ("dog-2", "robot"),
        )
    ],
}


@pytest.fixture(scope="module")
def site() -> Site:
    return parse_site(SITE, "test")


def granted(site: Site, user: str, message: str, flow: str) -> set[str]:
    block = access_control(site)
    rules = {rule["id"]: rule for rule in block["rules"]}
    ids = [id for policy in block["policies"] if policy["subjects"] == [user] for id in policy["rules"]]
    fitting = [rules[id] for id in ids if message in rules[id]["messages"] and flow in rules[id]["flows"]]
    return {key for rule in fitting for key in rule["key_exprs"]}


def test_denied_unless_granted(site: Site) -> None:
    block = access_control(site)
    assert block["enabled"] is True
    assert block["default_permission"] == "deny"
    assert {rule["permission"] for rule in block["rules"]} == {"allow"}


def test_every_process_and_guest_is_a_user_but_not_the_router(site: Site) -> None:
    assert [user.name for user in users_of(site)] == [
        "sim", "hub", "planner", "view", "cctv-1", "cctv-2", "dog-1", "dog-2", "console", "evaluator", "recorder",
    ]  # fmt: skip


def test_truth_is_sent_to_the_evaluator_only(site: Site) -> None:
    for user in users_of(site):
        heard = granted(site, user.name, "put", "egress") | granted(site, user.name, "reply", "egress")
        truths = {key for key in heard if key.startswith("r2x/gt/")}
        assert truths == ({"r2x/gt/state", "r2x/gt/judge"} if user.name == "evaluator" else set())
        assert not any("**" in key for key in heard)


def test_a_camera_speaks_for_itself_only(site: Site) -> None:
    said = granted(site, "cctv-1", "put", "ingress")
    assert "r2x/observation/cam-1" in said
    assert {"r2x/health/cctv-1", "r2x/clock/done/cctv-1"} <= said
    assert not any("2" in key.removeprefix("r2x/") or "*" in key for key in said)
    assert granted(site, "cctv-1", "liveliness_token", "ingress") == {"r2x/alive/cctv-1"}


def test_a_robot_hears_its_own_orders_and_the_hubs_heart(site: Site) -> None:
    heard = granted(site, "dog-1", "put", "egress")
    assert "r2x/robot/dog-1/traffic" in heard
    assert "r2x/robot/dog-2/traffic" not in heard
    assert "r2x/health/*" in heard
    assert granted(site, "dog-1", "query", "ingress") == {"r2x/world/snapshot", "r2x/planner/look"}


def test_only_the_hub_commands_robots(site: Site) -> None:
    askers = [u.name for u in users_of(site) if "r2x/robot/*/goal" in granted(site, u.name, "query", "ingress")]
    assert askers == ["hub"]


def test_a_camera_named_in_the_arguments() -> None:
    process = Process(id="cctv-9", role="cctv", module="m", args=("--camera", "cam-4"))
    assert devices_of(process) == ("cctv-9", "cam-4")


def test_consoles_share_a_user(site: Site) -> None:
    assert "r2x/alive/console$*" in granted(site, "console", "liveliness_token", "ingress")
