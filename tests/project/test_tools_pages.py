"""The generated pages are up to date, and the map of RAWSim-O's measures is complete."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from rmfs.measure.dictionary import TABLES, markdown
from rmfs.rawsimo.footprint import COLUMNS
from rmfs.rawsimo.output_files import FILES
from tests.tools.fields import sections
from tests.tools.pages import (
    DICTIONARY,
    FORMATS,
    FROM_RAWSIMO,
    with_fields,
    with_measures,
    write_pages,
)

ROOT = Path(__file__).resolve().parents[2]
REFERENCE = ROOT / "../shared/reference/rawsimo-inputs-outputs.md"
KNOWN = {f"{table}.{column.name}" for table, columns in TABLES.items() for column in columns} | {
    column.name for column in TABLES["footprint"]
}


def test_the_dictionary_page_is_up_to_date():
    page = (ROOT / "docs" / DICTIONARY).read_text(encoding="utf-8")
    assert page == markdown(), "run: python -m tests.tools.pages"


def test_the_page_for_users_of_rawsimo_is_up_to_date():
    page = (ROOT / "docs" / FROM_RAWSIMO).read_text(encoding="utf-8")
    assert page == with_measures(page), "run: python -m tests.tools.pages"


def test_the_fields_of_file_formats_are_up_to_date():
    page = (ROOT / "docs" / FORMATS).read_text(encoding="utf-8")
    assert page == with_fields(page), "run: python -m tests.tools.pages"


@pytest.mark.parametrize("name", sections())
def test_every_field_says_what_it_means(name):
    rows = [line for line in sections()[name].splitlines() if line.startswith("| `")]
    assert len(rows) >= 4
    assert all(row.split(" | ")[-1].strip(" |") for row in rows)


def test_the_explicit_layout_is_described_to_its_last_key():
    """All keys of a file as it is written are on the page, those of tables within tables too."""
    told = sections()["explicit layout"]
    layout = json.loads((ROOT / "instances/layouts/demonstrator.json").read_text())
    keys = {key for key, _ in _keys(layout)}
    assert {"to", "waypoint", "travel_s", "unit_pick_s", "heading_rad"} - {"travel_s"} <= keys
    assert all(f"| `{key}` |" in told for key in keys)
    assert "`elevators[].rides[]`: an elevator ride from one boarding waypoint" in told


def _keys(value):
    if isinstance(value, dict):
        for key, item in value.items():
            yield key, item
            yield from _keys(item)
    elif isinstance(value, list):
        for item in value:
            yield from _keys(item)


def test_what_others_wrote_around_the_generated_part_stays(tmp_path):
    (tmp_path / FROM_RAWSIMO).write_text(with_measures("# Title\n\nbefore\n\n") + "after\n")
    write_pages(tmp_path)
    page = (tmp_path / FROM_RAWSIMO).read_text()
    assert page.startswith("# Title\n\nbefore\n\n")
    assert page.endswith("after\n")


def test_every_column_is_mapped_once():
    assert len({one.theirs for one in COLUMNS}) == len(COLUMNS) == 273
    assert len({one.theirs for one in FILES}) == len(FILES)


@pytest.mark.parametrize("one", [*COLUMNS, *FILES], ids=lambda one: one.theirs)
def test_what_is_named_exists_or_there_is_a_reason(one):
    named = re.findall(r"`([^`]+)`", one.ours)
    assert set(named) <= KNOWN
    assert len(one.ours) > 2


@pytest.mark.skipif(not REFERENCE.is_file(), reason="the reference is not beside the checkout")
def test_columns_and_files_are_those_of_the_reference():
    text = REFERENCE.read_text(encoding="utf-8")
    columns = text[text.index("### 4.2") : text.index("### 4.3")]
    assert re.findall(r"^\| \d+ \| (\w+) \|", columns, re.M) == [one.theirs for one in COLUMNS]
    files = text[text.index("### 4.1") : text.index("Two further names")]
    rows = [line.split("|")[1] for line in files.splitlines() if line.startswith("| ")][1:]
    named = [name for row in rows for name in re.findall(r"[\w]+\.\w+", row)]
    assert sorted(named) == sorted(one.theirs for one in FILES)
