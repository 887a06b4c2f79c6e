"""Twins: a fit to generated orders recovers what generated them; counts against scipy."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from rmfs.cli import main
from rmfs.errors import InputError
from rmfs.scenario import load, sku_set
from rmfs.scenario.counts import ListedCount
from rmfs.scenario.distributions import Gamma
from rmfs.scenario.intake import Site
from rmfs.scenario.intake.export import export_stream
from rmfs.scenario.parameters import (
    GeneratedAffinity,
    GeneratedSkus,
    Orders,
    PoissonDemand,
    Scenario,
)
from rmfs.scenario.parameters.rates import ORDER_WEIGHTS, OrderSteps
from rmfs.scenario.twin import fit_twin
from rmfs.scenario.twin.affinity import lift, neighbours
from rmfs.scenario.twin.arrivals import HOUR_US, fit_arrivals
from rmfs.scenario.twin.popularity import fit_popularity

SKUS, SHAPE, SHARE, PER_H = 300, 0.8, 0.35, 60.0
LINES, UNITS = (4, 3, 2, 1), (5, 1, 0, 1)
SEEDS = range(12)
ANYWHERE = Site(1, 1, capacity=math.inf, largest_pod=math.inf)
HOURS = np.array(ORDER_WEIGHTS) / np.mean(ORDER_WEIGHTS) * PER_H


def truth(seed, share=SHARE, days=3):
    affinity = GeneratedAffinity(share=share, pairs=SKUS, default_weight=0.0)
    popularity = Gamma(shape=SHAPE, scale=1 / SHAPE)
    skus = GeneratedSkus(count=SKUS, seed=seed, popularity=popularity, affinity=affinity)
    return Scenario(
        format="rmfs-scenario/1",
        name="truth",
        duration_s=days * 86400.0 - 1,
        warmup_s=0.0,
        skus=skus,
        orders=Orders(lines=ListedCount(weights=LINES), units_per_line=ListedCount(weights=UNITS)),
        demand=PoissonDemand(
            orders_per_h=PER_H, per_station=False, initial_orders=0, profile=OrderSteps()
        ),
    )


def exported(scenario, path, seed=0):
    export_stream(scenario, "orders", path, ANYWHERE, seed)
    return path


def covered(estimates, known):
    return [estimates[name].low <= value <= estimates[name].high for name, value in known.items()]


@pytest.fixture(scope="module")
def twins(tmp_path_factory):
    folder = tmp_path_factory.mktemp("twins")
    return [
        fit_twin(exported(truth(seed), folder / f"{seed}.csv", seed), "twin", seed=50 + seed)
        for seed in SEEDS
    ]


KNOWN = {"SKUs": SKUS, "popularity shape": SHAPE, "affinity share": SHARE, "orders per h": PER_H}


@pytest.mark.parametrize("name", KNOWN)
def test_a_refit_recovers_a_parameter(twins, name):
    """In 12 fits the 95 % interval misses it three times with probability 2 %."""
    found = [{one.name: one for one in twin.estimates}[name] for twin in twins]
    assert sum(one.low <= KNOWN[name] <= one.high for one in found) >= 10
    # nor is the interval so wide that it says nothing
    assert np.median([(one.high - one.low) / one.value for one in found]) < 0.6
    assert np.mean([one.value for one in found]) == pytest.approx(KNOWN[name], rel=0.08)


def test_a_refit_recovers_shares_and_hours(twins):
    known = {f"share of orders with lines {n}": w / 10 for n, w in enumerate(LINES, 1)}
    known |= {f"share of lines with units {n}": w / 7 for n, w in enumerate(UNITS, 1)}
    known |= {f"orders per h in hour {n:02d}": rate for n, rate in enumerate(HOURS)}
    hits = []
    for twin in twins:
        hits += covered({one.name: one for one in twin.estimates}, known)
    assert len(hits) == 12 * 32
    assert stats.binomtest(sum(hits), len(hits), 0.95).pvalue > 0.001 or np.mean(hits) > 0.95


def test_a_twin_of_a_twin_is_like_it(twins, tmp_path):
    """The twin generates orders, to which another twin is fitted: its intervals hold the first."""
    first = twins[0]
    days = first.scenario.model_copy(update={"duration_s": 4 * 86400.0 - 1, "warmup_s": 0.0})
    second = fit_twin(exported(days, tmp_path / "again.csv", 77), "second", seed=9)
    skus = first.scenario.skus
    known = {
        "SKUs": skus.count,
        "popularity shape": skus.popularity.shape,
        "affinity share": skus.affinity.share,
        "orders per h": first.scenario.demand.orders_per_h,
    }
    assert all(covered({one.name: one for one in second.estimates}, known))


def test_the_fit_is_told(twins):
    for twin in twins[:4]:
        found = {one.name: one for one in twin.agreements}
        for name in ("orders per h", "lines per order, mean", "units per line, sd"):
            assert found[name].twin == pytest.approx(found[name].data, rel=0.06)
        assert found["share of the orders for the most popular tenth"].p > 0.001
        assert found["variance / mean of the orders per hour"].p > 0.001
        lifts = found["repeated pairs of SKUs, relative to chance"]
        assert lifts.data > 5
        assert lifts.twin == pytest.approx(lifts.data, rel=0.5)


def test_what_does_not_fit_is_told():
    """Orders in heaps are no Poisson process, and popularity in two classes is not gamma."""
    heaps = np.sort(np.repeat(np.random.default_rng(1).integers(0, 72 * HOUR_US, 200), 10))
    found = fit_arrivals(heaps, 3, 24)
    assert found.dispersion > 5
    assert found.p < 1e-6
    rng = np.random.default_rng(2)
    classes = np.concatenate([rng.poisson(3, 500), rng.poisson(60, 500)])
    assert fit_popularity(classes[classes > 0]).p < 1e-6


def test_without_affinity_none_is_found(tmp_path):
    twin = fit_twin(exported(truth(3, share=0.0), tmp_path / "o.csv", 3), "twin", seed=8)
    assert twin.scenario.skus.affinity is None
    share = {one.name: one for one in twin.estimates}["affinity share"]
    assert share.low == 0 <= share.value < 0.05


def test_the_lift_of_pairs_that_are_independent_is_one():
    rng = np.random.default_rng(4)
    weights = rng.gamma(0.8, size=200)
    lifts = []
    for _ in range(20):
        first, second = rng.choice(200, (2, 6000), p=weights / weights.sum())
        apart = first != second
        lifts.append(lift(first[apart], second[apart], 200))
    assert np.mean(lifts) == pytest.approx(1.0, abs=0.05)


def test_neighbours_are_of_one_order():
    sku, first_line = np.array([7, 8, 9, 1, 2]), np.array([0, 3, 4, 5])
    assert [part.tolist() for part in neighbours(sku, first_line)] == [[7, 8], [8, 9], [0, 0]]


def test_counts_of_unseen_skus():
    """Zero-truncated negative binomial: shape and SKUs of drawn counts, without affinity."""
    hits = []
    for seed in range(20):
        rng = np.random.default_rng(seed)
        counts = rng.poisson(4.0 * rng.gamma(0.5, 2.0, 800))
        found = fit_popularity(counts[counts > 0])
        hits += [found.skus.low <= 800 <= found.skus.high, found.shape.low <= 0.5]
        hits += [found.shape.high >= 0.5]
    assert np.mean(hits) > 0.93


def test_rates_of_a_week(tmp_path):
    orders = exported(truth(1, days=8), tmp_path / "o.csv", 1)
    twin = fit_twin(orders, "twin", weekly=True)
    profile = twin.scenario.demand.profile
    assert (profile.cycle_s, len(profile.weights)) == (604800.0, 168)
    with pytest.raises(InputError, match="needs orders of at least 7 days"):
        fit_twin(exported(truth(1), tmp_path / "o.csv", 1), "twin", weekly=True)


def test_the_command(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    exported(truth(2, days=2), tmp_path / "orders.csv", 2)
    given = ["scenario", "twin", "orders.csv", "--table", "fit.csv"]
    assert main(given) == 0
    told = capsys.readouterr().out
    assert "popularity shape" in told
    assert "twin.toml: written" in told
    scenario = load(tmp_path / "twin.toml")
    assert scenario.demand.mode == "poisson"
    rows = (tmp_path / "fit.csv").read_text().splitlines()
    assert rows[0] == "kind,name,value,low,high,twin,p"
    assert sum(row.startswith("parameter,orders per h in hour") for row in rows) == 24
    text = (tmp_path / "twin.toml").read_text()
    assert main(given) == 2
    assert "exists already" in capsys.readouterr().err
    assert main([*given, "--force"]) == 0
    assert (tmp_path / "twin.toml").read_text() == text
    (tmp_path / "few.csv").write_text("time,order,sku,quantity\n1,1,a,1\n2,2,b,1\n")
    capsys.readouterr()
    assert main(["scenario", "twin", "few.csv", "--out", "few.toml"]) == 2
    told = capsys.readouterr().err
    assert "few.csv: there are too few orders for a fit" in told
    assert told.count("\n") == 1
    assert not (tmp_path / "few.toml").exists()


def uneven(path):
    """Orders of SKUs whose popularity falls as 1 / rank^1.3, which no gamma weights are like."""
    rng = np.random.default_rng(6)
    weights = np.arange(1, 2001) ** -1.3
    skus = rng.choice(2000, 6000, p=weights / weights.sum())
    times = np.sort(rng.random(6000) * 3 * 86400)
    rows = [f"{t:.3f},{n},S{k},1" for n, (t, k) in enumerate(zip(times, skus, strict=True))]
    path.write_text("\n".join(["time,order,sku,quantity", *rows]) + "\n")
    return path


def test_popularity_that_is_too_uneven_is_kept_as_it_is(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    uneven(tmp_path / "o.csv")
    assert main(["scenario", "twin", "o.csv"]) == 2
    assert "--listed, which keeps the popularity of each" in capsys.readouterr().err
    assert main(["scenario", "twin", "o.csv", "--listed"]) == 0
    text = (tmp_path / "twin-skus.json").read_text()
    assert "S1" not in text  # no name of the file
    scenario = load(tmp_path / "twin.toml")
    skus = sku_set(scenario.skus)
    made = exported(scenario.model_copy(update={"duration_s": 3 * 86400.0}), tmp_path / "t.csv")
    data, twin = (
        np.sort(np.unique(np.loadtxt(path, str, delimiter=",", skiprows=1)[:, 2],
                          return_counts=True)[1])[::-1]
        for path in (tmp_path / "o.csv", made)
    )  # fmt: skip
    assert len(skus) == len(data)
    assert twin[:50].sum() / twin.sum() == pytest.approx(data[:50].sum() / data.sum(), abs=0.03)
    (tmp_path / "twin.toml").unlink()
    assert main(["scenario", "twin", "o.csv", "--listed"]) == 2
    assert "twin-skus.json: exists already" in capsys.readouterr().err


def test_a_fit_does_not_hang_on_where_it_begins():
    """Counts with a mean of 1 and more, and of a few hundred."""
    for mean in (0.7, 2.8, 400.0):
        rng = np.random.default_rng(3)
        counts = rng.poisson(mean * rng.gamma(0.3, 1 / 0.3, 3000))
        found = fit_popularity(counts[counts > 0]).shape
        assert found.low < 0.3 < found.high
        assert found.high < 0.7


def test_a_parquet_file_gives_the_twin_of_the_csv_file(tmp_path):
    rng = np.random.default_rng(1)
    table = pd.DataFrame(
        {
            "time": np.sort(rng.uniform(0, 86400, 800)).round(3),
            "order": np.arange(800),
            "sku": rng.zipf(1.5, 800) % 60,
            "quantity": 1,
        }
    )
    table.to_csv(tmp_path / "orders.csv", index=False)
    table.to_parquet(tmp_path / "orders.parquet")
    as_csv, as_parquet = (
        fit_twin(tmp_path / f"orders.{kind}", "twin", listed=True) for kind in ("csv", "parquet")
    )
    assert as_parquet.estimates == as_csv.estimates
    assert as_parquet.skus.digest() == as_csv.skus.digest()


@pytest.mark.parametrize("name", ["none.csv", "none.txt"])
def test_a_file_that_is_not_there_is_told_in_one_line(tmp_path, name):
    with pytest.raises(InputError, match=r"none\..*: file: (no such file|must end in)"):
        fit_twin(tmp_path / name, "twin")


def test_listed_counts():
    draw = ListedCount(weights=(1, 0, 3)).sampler()
    numbers = [draw(u) for u in np.random.default_rng(1).random(4000)]
    found = np.bincount(numbers, minlength=4)[1:]
    assert found[1] == 0
    assert stats.binomtest(int(found[0]), 4000, 0.25).pvalue > 0.01
    for weights in ((), (1, 0), (-1, 2)):
        with pytest.raises(ValueError, match="validation error"):
            ListedCount(weights=weights)
