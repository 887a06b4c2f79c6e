"""RAWSim-O's SKU sets, sound, broken and hostile."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from rmfs.errors import InputError
from rmfs.rawsimo.scenario import read_xgenc
from rmfs.scenario import OrderSource, load, sku_set
from rmfs.scenario.counts import NormalCount
from rmfs.scenario.parameters import Orders, SkuFile

ONE = NormalCount(mean=1.0, sd=0.0, min=1, max=1)
TWO = NormalCount(mean=2.0, sd=0.0, min=2, max=2)


def pairs(tag: str, values: dict[int, object]) -> str:
    rows = "".join(
        f"<SkvpOfInt32Double><Key>{key}</Key><Value>{value}</Value></SkvpOfInt32Double>"
        for key, value in values.items()
    )
    return f"<{tag}>{rows}</{tag}>"


def triples(values: dict[tuple[int, int], float]) -> str:
    rows = "".join(
        f"<Skkvt><Key1>{first}</Key1><Key2>{second}</Key2><Value>{value}</Value></Skkvt>"
        for (first, second), value in values.items()
    )
    return f"<ItemCoWeights>{rows}</ItemCoWeights>"


THREE = pairs("ItemDescriptions", {7: 1.0, 8: 2.0, 9: 3.0})


def written(folder: Path, body: str, root: str = "SimpleItemGeneratorConfiguration") -> Path:
    path = folder / "skus.xgenc"
    path.write_text(f'<?xml version="1.0"?><{root}>{body}</{root}>')
    return path


def test_a_file_with_everything(tmp_path: Path):
    body = (
        "<Name>three</Name><DefaultWeight>0.5</DefaultWeight><DefaultCoWeight>0.2</DefaultCoWeight>"
        "<ProbToUseCoWeight>0.25</ProbToUseCoWeight>"
        + THREE
        + pairs("ItemDescriptionWeights", {9: 3.5, 8: 2.5, 7: 1.5})
        + pairs("ItemDescriptionBundleSizes", {7: 10, 8: 20, 9: 30})
        + pairs("ItemWeights", {7: 4, 9: 1e-3})
        + triples({(7, 8): 0.9, (8, 7): 0.1, (9, 7): 0.3})
    )
    skus = sku_set(SkuFile(file=written(tmp_path, body)))
    assert skus.ids.tolist() == [7, 8, 9]
    assert skus.popularity == pytest.approx([4.0, 0.5, 1e-3], rel=1e-9)
    assert skus.space_per_unit.tolist() == [1.5, 2.5, 3.5]
    assert skus.bundle_units.tolist() == [10, 20, 30]
    affinity = skus.affinity
    assert affinity is not None
    assert (affinity.share, affinity.default_weight) == (0.25, 0.2)
    given = zip(affinity.first.tolist(), affinity.second.tolist(), affinity.weight, strict=True)
    assert list(given) == [(0, 1, 0.9), (0, 2, 0.3), (1, 0, 0.1), (2, 0, 0.3)]


def test_sizes_missing_in_the_file_are_drawn(tmp_path: Path):
    path = written(tmp_path, THREE)
    skus = sku_set(SkuFile(file=path))
    assert skus.popularity.tolist() == [1.0, 1.0, 1.0]
    assert ((skus.space_per_unit >= 2) & (skus.space_per_unit <= 8)).all()
    assert ((skus.bundle_units >= 4) & (skus.bundle_units <= 12)).all()
    assert skus.affinity is None
    assert sku_set(SkuFile(file=path, seed=1)).digest() != skus.digest()


def test_lines_drawn_by_affinity_follow_the_line_before(tmp_path: Path):
    body = (
        "<ProbToUseCoWeight>0.5</ProbToUseCoWeight><DefaultCoWeight>0</DefaultCoWeight>"
        + pairs("ItemDescriptions", dict.fromkeys(range(4), 1.0))
        + pairs("ItemWeights", {0: 1, 1: 1, 2: 1, 3: 1})
        + triples({(0, 1): 1.0, (2, 3): 1.0})
    )
    skus = sku_set(SkuFile(file=written(tmp_path, body)))
    source = OrderSource(Orders(lines=TWO, units_per_line=ONE), skus, seed=1)
    drawn = [source.draw(k, np.full(4, 9)) for k in range(6000)]
    partners = sum(set(order.skus) in ({0, 1}, {2, 3}) for order in drawn)
    # half of the second lines by affinity (always the partner), the others one of three SKUs
    assert stats.binomtest(partners, 6000, 0.5 + 0.5 / 3).pvalue > 0.01


def test_affinity_to_nobody_falls_back_to_popularity(tmp_path: Path):
    body = (
        "<ProbToUseCoWeight>1</ProbToUseCoWeight>"
        + THREE
        + pairs("ItemWeights", {7: 1, 8: 1, 9: 1})
        + triples({(7, 8): 1.0})
    )
    skus = sku_set(SkuFile(file=written(tmp_path, body)))
    source = OrderSource(Orders(lines=TWO, units_per_line=ONE), skus, seed=1)
    drawn = [source.draw(k, np.full(3, 9)) for k in range(300)]
    assert all(order is not None for order in drawn)
    assert {order.skus[1] for order in drawn if order.skus[0] == 0} == {1}
    assert {order.skus[1] for order in drawn if order.skus[0] == 2} == {0, 1}


BROKEN = {
    "": "lists no SKU",
    pairs("ItemDescriptions", {7: "x"}): "<Value> must be a finite number",
    pairs("ItemDescriptions", {7: "NaN"}): "<Value> must be a finite number",
    "<ItemDescriptions><A><Key>1.5</Key><Value>1</Value></A></ItemDescriptions>": "whole number",
    "<ItemDescriptions><A><Value>1</Value></A></ItemDescriptions>": "<Key> must be a finite",
    THREE + THREE: "<ItemDescriptions> appears twice",
    THREE + "<Colour/>": "unknown element <Colour>",
    THREE + pairs("ItemWeights", {6: 1}): "SKU 6 is not listed",
    THREE + pairs("ItemWeights", {7: -1}): "must not be negative",
    THREE + pairs("ItemWeights", {7: 0, 8: 0, 9: 0}): "no SKU has a positive popularity",
    THREE + pairs("ItemDescriptionWeights", {7: 1}): "gives no positive value for SKU 8",
    THREE + pairs("ItemDescriptionBundleSizes", {7: 1, 8: 1.5, 9: 1}): "whole numbers",
    THREE + triples({(7, 1): 1.0}): "SKU 1 is not listed",
    THREE + "<ProbToUseCoWeight>2</ProbToUseCoWeight>": "at most 1",
    pairs("ItemDescriptions", {7: 1}).replace("</ItemDescriptions>", "")
    + "<A><Key>7</Key><Value>1</Value></A></ItemDescriptions>": "lists SKU 7 twice",
}


@pytest.mark.parametrize(("body", "problem"), BROKEN.items())
def test_a_broken_file_is_one_clear_error(tmp_path: Path, body: str, problem: str):
    path = written(tmp_path, body)
    with pytest.raises(InputError) as caught:
        read_xgenc(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert problem in message
    assert "\n" not in message


LAUGHS = "".join(f'<!ENTITY a{i} "{f"&a{i - 1};" * 10 if i else "ha"}">' for i in range(12))
HOSTILE = {
    "billion laughs": f"<!DOCTYPE r [{LAUGHS}]><r>&a11;</r>",
    "external entity": '<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]><r>&x;</r>',
    "external subset": '<!DOCTYPE r SYSTEM "file:///etc/passwd"><r/>',
}


@pytest.mark.parametrize("text", HOSTILE.values(), ids=HOSTILE.keys())
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_a_document_type_is_refused(tmp_path: Path, text: str, encoding: str):
    path = tmp_path / "hostile.xgenc"
    path.write_bytes(text.encode(encoding))
    with pytest.raises(InputError, match="declares a document type"):
        read_xgenc(path)


@pytest.mark.parametrize(
    "content", [b"\x00\x01\xff", b"<a>", b"<a>&x;</a>", b"<?xml version='1.0' encoding='x'?>"]
)
def test_what_is_not_xml_is_refused(tmp_path: Path, content: bytes):
    path = tmp_path / "broken.xgenc"
    path.write_bytes(content)
    with pytest.raises(InputError, match="not a complete XML file"):
        read_xgenc(path)


def test_another_root_or_no_file(tmp_path: Path):
    with pytest.raises(InputError, match="root element is <Instance>"):
        read_xgenc(written(tmp_path, "", root="Instance"))
    with pytest.raises(InputError, match="no such file"):
        read_xgenc(tmp_path / "none.xgenc")


def test_a_huge_file_is_refused_early(tmp_path: Path):
    path = tmp_path / "huge.xgenc"
    with path.open("wb") as file:
        file.write(b"<SimpleItemGeneratorConfiguration>")
        file.truncate(2**32)
    with pytest.raises(InputError, match="not a complete XML file"):
        read_xgenc(path)
    with path.open("wb") as file:
        file.writelines([b"<a>", *[b"<b>" + b" " * 2**18 + b"</b>"] * 257])
    with pytest.raises(InputError, match="larger than 64 MiB"):
        read_xgenc(path)


def test_all_published_sets_are_read(reference: Path):
    counts = {}
    for path in sorted((reference / "resources").glob("*.xgenc")):
        skus = sku_set(SkuFile(file=path))
        assert (skus.space_per_unit > 0).all()
        counts[path.stem] = len(skus)
    assert counts == {
        "Delta-1000": 1000,
        "ItemGen-100-100-10000": 100,
        "ItemGenMinimalistic": 2,
        "MaTi-10": 10,
        "MaTi-100": 100,
        "MaTi-1000": 1000,
        "Mu-100": 100,
        "Mu-1000": 1000,
    }


def test_all_affinities_of_a_published_set(reference: Path):
    affinity = read_xgenc(reference / "resources/ItemGen-100-100-10000.xgenc").affinity
    assert affinity is not None
    assert len(affinity.weight) == 10_000
    assert affinity.share == 0.0


def test_the_skus_of_basic_are_like_the_published_ones(reference: Path):
    published = read_xgenc(reference / "resources/Mu-1000.xgenc")
    skus = sku_set(load("basic").skus)
    for ours, theirs in (
        (skus.popularity, published.popularity),
        (skus.space_per_unit, published.space_per_unit),
    ):
        assert stats.ks_2samp(ours, theirs).pvalue > 0.01
    sizes = np.stack([np.bincount(skus.bundle_units), np.bincount(published.bundle_units)])
    assert stats.chi2_contingency(sizes[:, 4:]).pvalue > 0.01
