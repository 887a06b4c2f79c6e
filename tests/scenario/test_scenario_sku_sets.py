"""SKU sets in files, drawn affinities, and the picture of popularity."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from scenario_tools import SIGNIFICANT
from scipy import integrate, stats

from rmfs.errors import InputError
from rmfs.rawsimo.scenario import read_xgenc
from rmfs.scenario import SkuSet, read_sku_set, sku_set, write_sku_set
from rmfs.scenario.parameters import GeneratedAffinity, GeneratedSkus, SkuFile
from rmfs.scenario.skus import Affinity
from rmfs.scenario.skus.csv_file import read_sku_table
from rmfs.scenario.skus.drawing import draw_affinity
from rmfs.scenario.skus.picture import draw_popularity, save_picture
from rmfs.scenario.streams import read_orders

LETTERS = SkuSet(
    ids=np.array([5, 3]),
    popularity=np.array([1.0, 2.0]),
    space_per_unit=np.array([1.0, 2.5]),
    bundle_units=np.array([4, 6]),
    names=("a red", "b ü"),
)


def with_affinity(count: int = 50, pairs: int = 30) -> SkuSet:
    affinity = GeneratedAffinity(share=0.3, pairs=pairs)
    return sku_set(GeneratedSkus(count=count, affinity=affinity))


@pytest.mark.parametrize("skus", [LETTERS, with_affinity(), sku_set(GeneratedSkus())])
def test_a_set_survives_its_file(tmp_path: Path, skus: SkuSet):
    path = tmp_path / "skus.json"
    write_sku_set(skus, path, "of a test")
    again = read_sku_set(path)
    assert again.digest() == skus.digest()
    assert again.names == skus.names
    assert (again.affinity is None) == (skus.affinity is None)
    assert sku_set(SkuFile(file=path)).digest() == skus.digest()
    assert len(path.read_text().splitlines()) < 15


CONTENT = {
    "format": "rmfs-skus/1",
    "ids": [1, 2],
    "popularity": [1, 0],
    "space_per_unit": [1.5, 2],
    "bundle_units": [1, 2],
}
WRONG = [
    ({"format": "rmfs-scenario/1"}, "format: Input should be 'rmfs-skus/1'"),
    ({"colours": [1]}, "unknown key colours; valid: affinity"),
    ({"ids": []}, "ids: List should have at least 1 item"),
    ({"ids": [1, 1]}, "ids: a SKU occurs twice"),
    ({"ids": [1, "2"]}, "ids.1: Input should be a valid integer"),
    ({"popularity": [1]}, "popularity: 1 values, expected 2"),
    ({"popularity": [0, 0]}, "popularity: at least one value must be positive"),
    ({"popularity": [1, -1]}, "popularity.1: Input should be greater than or equal to 0"),
    ({"space_per_unit": [0, 1]}, "space_per_unit.0: Input should be greater than 0"),
    ({"bundle_units": [1, 1.5]}, "bundle_units.1: Input should be a valid integer"),
    ({"names": ["a"]}, "names: 1 values, expected 2"),
    ({"digest": "0"}, "digest: does not match the content"),
    (
        {"affinity": {"share": 1, "default_weight": 0, "first": [7], "second": [1], "weight": [1]}},
        "affinity.first: SKU 7 is not among ids",
    ),
    (
        {"affinity": {"share": 1, "default_weight": 0, "first": [1], "second": [], "weight": [1]}},
        "affinity.second: 0 values, expected 1",
    ),
    ({"popularity": [-1] * 100_000}, "popularity.0: Input should be greater"),
]


@pytest.mark.parametrize(("change", "problem"), WRONG)
def test_a_wrong_file_is_one_clear_error(tmp_path: Path, change, problem: str):
    path = tmp_path / "skus.json"
    path.write_text(json.dumps(CONTENT))
    assert len(read_sku_set(path)) == 2
    path.write_text(json.dumps(CONTENT | change))
    with pytest.raises(InputError) as caught:
        read_sku_set(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: {problem}")
    assert len(message) < len(str(path)) + 300


@pytest.mark.parametrize(
    "content", [b"", b"[]", b"{", b"\x00\xff", b"[" * 100_000, b'{"popularity": [NaN]}']
)
def test_what_is_no_set_is_refused(tmp_path: Path, content: bytes):
    path = tmp_path / "skus.json"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_sku_set(path)
    assert str(caught.value).startswith(f"{path}: ")


def test_names_of_files(tmp_path: Path):
    with pytest.raises(InputError, match=r"must end in \.json"):
        write_sku_set(LETTERS, tmp_path / "skus.toml")
    with pytest.raises(InputError, match="no such file"):
        read_sku_set(tmp_path / "none.json")
    with pytest.raises(InputError, match="cannot be read"):
        read_sku_set(tmp_path)


# --- affinity -----------------------------------------------------------------------------------


def distance_cdf(distance: np.ndarray) -> np.ndarray:
    """Distribution of the distance of two points in the unit square (square line picking)."""

    def density(d: float) -> float:
        if d <= 1:
            return 2 * d * (d * d - 4 * d + np.pi)
        root = np.sqrt(d * d - 1)
        return 2 * d * (4 * root - (d * d + 2 - np.pi) - 4 * np.arctan(root))

    grid = np.linspace(0, np.sqrt(2), 2001)
    cumulative = integrate.cumulative_simpson([density(d) for d in grid], x=grid, initial=0)
    return np.interp(distance, grid, cumulative)


def matrix(affinity: Affinity, count: int) -> np.ndarray:
    weights = np.full((count, count), np.nan)
    weights[affinity.first, affinity.second] = affinity.weight
    return weights


def dimensions(distances: np.ndarray) -> int:
    """In how many dimensions points have these distances (classical scaling)."""
    centred = np.eye(len(distances)) - 1 / len(distances)
    values = np.linalg.eigvalsh(-0.5 * centred @ distances**2 @ centred)
    return int((np.abs(values) > 1e-6).sum())


def test_affinities_are_distances_of_random_points():
    config = GeneratedAffinity(share=0.5, pairs=600 * 599 // 2)
    affinity = draw_affinity(config, seed=1, count=600)
    distances = np.sqrt(2) - matrix(affinity, 600)
    # pairs that share no SKU are independent
    apart = distances[np.arange(0, 600, 2), np.arange(1, 600, 2)]
    assert stats.kstest(apart, distance_cdf).pvalue > SIGNIFICANT
    np.fill_diagonal(distances, 0.0)
    assert dimensions(distances[:100, :100]) == 2
    assert (affinity.share, affinity.default_weight) == (0.5, 0.2)


def test_the_skus_of_a_published_set_are_points_too(reference: Path):
    published = read_xgenc(reference / "resources/ItemGen-100-100-10000.xgenc").affinity
    assert published is not None
    distances = matrix(published, 100)
    assert dimensions(distances) == 2
    apart = distances[np.arange(0, 100, 2), np.arange(1, 100, 2)]
    assert stats.kstest(apart, distance_cdf).pvalue > SIGNIFICANT


@pytest.mark.parametrize("pairs", [0, 1, 300, 434, 435])
def test_pairs_are_drawn_once_and_count_both_ways(pairs: int):
    affinity = draw_affinity(GeneratedAffinity(share=0.5, pairs=pairs), seed=1, count=30)
    drawn = set(zip(affinity.first.tolist(), affinity.second.tolist(), strict=True))
    assert len(drawn) == 2 * pairs
    assert all(first != second and (second, first) in drawn for first, second in drawn)
    assert (affinity.weight[:pairs] == affinity.weight[pairs:]).all()


def test_all_pairs_are_alike_likely():
    ends = [
        draw_affinity(GeneratedAffinity(share=0.5, pairs=5), seed=seed, count=6).first[:5] * 6
        + draw_affinity(GeneratedAffinity(share=0.5, pairs=5), seed=seed, count=6).second[:5]
        for seed in range(600)
    ]
    _, counts = np.unique(np.concatenate(ends), return_counts=True)
    assert len(counts) == 15
    # five of fifteen are drawn at a time, without repetition: less spread than in a chi-square
    assert stats.chisquare(counts).statistic < stats.chi2(14).isf(SIGNIFICANT)


def test_affinity_leaves_the_other_columns_alone():
    plain, related = sku_set(GeneratedSkus(count=50)), with_affinity()
    assert (plain.popularity == related.popularity).all()
    assert plain.digest() != related.digest()


# --- picture ------------------------------------------------------------------------------------


def curves(skus: SkuSet, cumulative: bool) -> tuple[np.ndarray, np.ndarray]:
    ax = Figure().subplots()
    assert draw_popularity(skus, ax, cumulative=cumulative) is None
    assert ax.get_xlabel()
    assert ax.get_ylabel()
    return ax.lines[-1].get_data()


def test_the_curve_falls_and_its_sum_reaches_all(skus: SkuSet):
    _, shares = curves(skus, cumulative=False)
    assert (np.diff(shares) <= 0).all()
    assert shares[0] == skus.by_popularity.probabilities.max()
    x, summed = curves(skus, cumulative=True)
    assert (x[0], x[-1], summed[0]) == (0, 1, 0)
    assert summed[-1] == pytest.approx(1)
    assert (np.diff(summed, 2) <= 1e-12).all()


@pytest.mark.parametrize("suffix", ["svg", "png", "pdf"])
def test_pictures_repeat(tmp_path: Path, skus: SkuSet, suffix: str):
    paths = [tmp_path / f"{name}.{suffix}" for name in "ab"]
    for path in paths:
        save_picture(skus, path)
    assert paths[0].stat().st_size > 1000
    if suffix == "png":
        assert paths[0].read_bytes() == paths[1].read_bytes()
    with pytest.raises(InputError, match="must end in"):
        save_picture(skus, tmp_path / "a.gif")


TABLE = """sku,popularity,supplier,space_per_unit
SHOE-41, 12,a,0.5
"HAT, RED",3.5,b,0.25

007,1,c,1
"""


def test_a_table_names_skus_and_leaves_the_rest_to_be_drawn(tmp_path: Path):
    path = tmp_path / "skus.csv"
    path.write_text(TABLE)
    found = sku_set(SkuFile(file=path))
    assert found.names == ("SHOE-41", "HAT, RED", "007") and found.ids.tolist() == [0, 1, 2]
    assert found.popularity.tolist() == [12.0, 3.5, 1.0]
    assert found.space_per_unit.tolist() == [0.5, 0.25, 1.0]
    assert (found.bundle_units >= 1).all()
    write_sku_set(found, tmp_path / "again.json")
    assert read_sku_set(tmp_path / "again.json").names == found.names
    orders = tmp_path / "orders.csv"
    orders.write_text('time,order,sku,quantity\n1,a,"HAT, RED",2\n1,a,007,1\n2,b,0,1\n')
    stream = read_orders(orders, found)
    assert stream.sku.tolist() == [1, 2, 0]
    orders.write_text("time,order,sku,quantity\n1,a,HAT,2\n")
    with pytest.raises(InputError, match="sku HAT is unknown"):
        read_orders(orders, found)


def test_numbers_stay_the_ids_of_a_table(tmp_path: Path):
    path = tmp_path / "skus.csv"
    path.write_bytes(b"\xef\xbb\xbfbundle_units,sku\r\n6,40\r\n8,7\r\n")
    found = sku_set(SkuFile(file=path))
    assert found.ids.tolist() == [40, 7] and found.names == ()
    assert found.bundle_units.tolist() == [6, 8] and found.popularity.tolist() == [1.0, 1.0]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "line 1: column sku is missing"),
        ("id,popularity\n1,2\n", "line 1: column sku is missing; columns: sku, popularity"),
        ("sku,sku\n1,2\n", "line 1: column sku occurs twice"),
        ("sku\n", "contains no SKU"),
        ("sku\na\na\n", "line 3: sku a occurs twice"),
        ("sku,popularity\na,1\nb\n", "line 3: 1 fields, expected 2"),
        ("sku,popularity\na,many\n", "line 2: popularity must be a positive number"),
        ("sku,popularity\na,nan\n", "line 2: popularity must be"),
        ("sku,popularity\na,0\n", "popularity: at least one value must be positive"),
        ("sku,space_per_unit\na,0\n", "line 2: space_per_unit must be"),
        ("sku,bundle_units\na,1.5\n", "line 2: bundle_units must be a whole number"),
        ('sku\n"a\n', "line 2: "),
        (f"sku\n{'x' * 201}\n", "line 2: sku must have 1 to 200 characters"),
        ("sku\n\ud800\n", "is not UTF-8 text"),
    ],
)
def test_what_is_wrong_in_a_table_is_told_with_its_line(tmp_path: Path, text: str, told: str):
    path = tmp_path / "skus.csv"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    with pytest.raises(InputError) as caught:
        read_sku_table(path)
    assert str(caught.value).startswith(f"{path}: ") and told in str(caught.value)
