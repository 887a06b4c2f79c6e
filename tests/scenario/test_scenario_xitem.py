"""RAWSim-O's order lists, broken in every way."""

from __future__ import annotations

from pathlib import Path

import pytest
from rawsimo_files import XITEM
from scenario_tools import scenario

from rmfs.errors import InputError
from rmfs.scenario import sku_set
from rmfs.scenario.parameters import SkuFile
from rmfs.scenario.sources import order_stream

BROKEN_LISTS = [
    ('Count="2"', 'Count="-2"', "order 1: quantity must be from 1"),
    ('Count="2"', f'Count="{"9" * 5000}"', "order 1: quantity must be a number"),
    ('ItemDescriptionID="4"', 'ItemDescriptionID="5"', "order 1: sku 5 is unknown"),
    ('ItemDescriptionID="4"', 'ItemDescriptionID="9"', "order 1: sku 9 occurs twice in order 1"),
    ('TimeStamp="3.25"', 'TimeStamp="1"', "order 2: time 1 is earlier than that of the previous"),
    ('TimeStamp="3.25"', "", "order 2: time must be a number of s, or a time such as"),
    ('<Position ItemDescriptionID="9" Count="1" />', "", "order 2: sku must be a number (empty)"),
    ('Weight="2"', 'Weight="0"', "ItemDescription 9: Weight must be a positive number"),
    ('ID="9" Type', 'ID="4" Type', "ItemDescription 4 occurs twice"),
    ('ID="9" Type', 'ID="x" Type', "ItemDescription: ID must be a whole number (given: 'x')"),
]


@pytest.mark.parametrize(("old", "new", "problem"), BROKEN_LISTS)
def test_broken_order_lists(tmp_path: Path, old: str, new: str, problem: str):
    assert old in XITEM
    path = tmp_path / "list.xitem"
    path.write_text(XITEM.replace(old, new, 1))
    with pytest.raises(InputError) as caught:
        given = scenario(demand={"mode": "stream", "file": str(path)})
        order_stream(given, sku_set(SkuFile(file=path)))
    assert str(caught.value).startswith(f"{path}: {problem}")


def test_a_letter_beyond_unicode_is_no_name(tmp_path: Path):
    """Neither an error nor a character; the first eight digits alone would be one."""
    assert 'Letter="98"' in XITEM
    code = "0000000" + "9" * 20
    path = tmp_path / "list.xitem"
    path.write_text(XITEM.replace('Letter="98"', f'Letter="{code}"', 1))
    assert sku_set(SkuFile(file=path)).names == ()
