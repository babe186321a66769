"""The page docs/fly-a-real-drone.md: its tables are good ones, and what it says of the code is so."""

import re
import tomllib

from devices.drone.airspace import NEEDED_M, UNDER_LINTEL_M
from devices.drone.flight import LEAST_BATTERY
from devices.drone.skills import SKILLS
from devices.drone.work import LOW_BATTERY
from tests.devices.drone.flat import flat
from tests.pages import ROOT, blocks
from wire.airlink import address_fault
from wire.site import UNDER_CEILING_M, parse_site

PAGE = "fly-a-real-drone.md"
TEXT = (ROOT / "docs" / PAGE).read_text()


def test_the_tables_of_the_page_are_good_ones() -> None:
    (text,) = blocks(PAGE, "toml")
    rows = tomllib.loads(text)
    data = flat().model_dump(exclude_unset=True) | {"robot": rows["robot"]}
    site = parse_site(data | {"process": [data["process"][0], *rows["process"]]}, PAGE)
    assert site.robot[0].link == "udpin://127.0.0.1:14540"


def test_the_addresses_of_the_page_are_good_ones() -> None:
    links = re.findall(r"^\| `(\w+://\S+)` \|", TEXT, re.MULTILINE)
    assert len(links) == 4
    assert not any(map(address_fault, links))


def test_the_figures_of_the_page_are_those_of_the_code() -> None:
    assert f"keeps {NEEDED_M:.2f} m from its" in TEXT
    assert f"{UNDER_CEILING_M:.1f} m below ceilings, {UNDER_LINTEL_M:.1f} m below lintels" in TEXT
    assert f"begun below {LEAST_BATTERY * 100:.0f} %, an idle drone lands below {LOW_BATTERY * 100:.0f} %" in TEXT


def test_the_page_names_every_skill() -> None:
    assert re.findall(r"`(\w+)`", TEXT.split("What it can be asked for")[1].split(";")[0]) == list(SKILLS)
