"""All published scenarios and order lists of RAWSim-O: nothing in them is dropped silently."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from scenario_tools import SITE, FakeState, drive

from rmfs.rawsimo.scenario import read_xitem, read_xsett, xsett
from rmfs.scenario import bundle_intake, initial_stock, order_intake, sku_set
from rmfs.scenario.loading import load_with_notes
from rmfs.scenario.parameters import SkuFile


def noted(notes: list[str], text: str) -> bool:
    return any(text in note for note in notes)


PUBLISHED = {
    "basic/BasicInstance": ("backlog", 1000),
    "core/jenPP": ("backlog", 100),
    "core/jenkinsObsolete": ("backlog", 18),
    "core/jenkinssetting1": ("backlog", 100),
    "core/jenkinssetting2": ("poisson", 100),
    "core/jenkinssetting3": ("backlog", 100),
    "demonstrator/steadysetting": ("backlog", 2),
    "fastlane/SimpleItem-Fill-200-200-172800": ("backlog", 1000),
    "mati/MaTi-SKU10": ("backlog", 10),
    "mati/MaTi-SKU100": ("backlog", 100),
    "mati/MaTi-SKU1000": ("backlog", 1000),
    "pp/PPMinimal": ("backlog", 1000),
}
DEAD = {
    "core/jenkinsObsolete": "HeatMode",
    "demonstrator/steadysetting": "HeatMode",
    "fastlane/SimpleItem-Fill-200-200-172800": "OrderTimestampDueDateOffsetMean",
    "pp/PPMinimal": "PPInstanceDumpFrequency",
}


def test_all_published_scenarios_are_imported(reference: Path):
    found = {}
    for path in sorted(reference.glob("*/*.xsett")):
        name = f"{path.parent.name}/{path.stem}"
        scenario, notes = load_with_notes(path)
        skus = sku_set(scenario.skus)
        found[name] = (scenario.demand.mode, len(skus))
        assert not noted(notes, "unknown"), name
        assert name not in DEAD or noted(notes, DEAD[name])
        initial_stock(skus, np.full(20, 500.0), scenario.stock.initial_share, seed=1)
        state = FakeState(len(skus))
        assert drive(order_intake(scenario, skus, SITE, 1), state, 7200 * 10**6), name
        bundle_intake(scenario, skus, SITE, 1)
    assert found == PUBLISHED


LISTS = ("ColorProbabilities", "TimeDependentOrderWeights", "TimeDependentBundleWeights")


def test_no_element_of_the_published_scenarios_is_dropped_silently(
    reference: Path, monkeypatch: pytest.MonkeyPatch
):
    """An element more in any block that is used is noted as unknown, so all others are known."""
    for path in sorted(reference.glob("*/*.xsett")):
        root = ElementTree.parse(path).getroot()
        monkeypatch.setattr(xsett, "read_root", lambda _path, _tag, given=root: given)
        for block in [block for block in root.iter() if len(block) and block.tag not in LISTS]:
            if block[0].tag == "Key":
                continue
            added = ElementTree.SubElement(block, "Unheard")
            notes = read_xsett(path).notes
            block.remove(added)
            used = not any(note.startswith(f"{block.tag} not used") for note in notes)
            assert noted(notes, "Unheard unknown") == used, (path, block.tag)


def test_the_published_order_list(reference: Path):
    path = reference / "resources/Letter-18-34-100-3518.56.xitem"
    order_list = read_xitem(path)
    assert order_list.notes == ()
    skus = sku_set(SkuFile(file=path))
    assert (len(skus), len(order_list.orders(skus)), len(order_list.bundles(skus))) == (18, 100, 34)
    assert skus.names[0] == "r blue"
