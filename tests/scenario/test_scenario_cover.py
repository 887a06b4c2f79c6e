"""Stock that covers a file of orders, and the SKUs of such a file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scenario_tools import scenario

import rmfs
from rmfs.errors import InputError
from rmfs.scenario import SkuSet, bundles_to_cover, initial_stock, sku_set
from rmfs.scenario.parameters import SkuFile

ORDERS = "time,order,sku,quantity\n0,A,0,7\n0,A,3,1\n60,B,0,4\n4000,C,1,50\n"


def covered(folder: Path, cover: float, **more: object):
    (folder / "orders.csv").write_text(ORDERS)
    demand = {"mode": "stream", "file": str(folder / "orders.csv")}
    return scenario(demand=demand, stock={"order_cover": cover, **more})


def test_whole_bundles_of_what_is_ordered_in_the_run(tmp_path: Path, few_skus: SkuSet):
    """SKU 0 is asked for 11 times, SKU 3 once; SKU 1 only after the end."""
    for cover in (0.5, 1.0, 2.0):
        found = bundles_to_cover(covered(tmp_path, cover), few_skus)
        units = np.bincount(found, minlength=5) * few_skus.bundle_units
        wanted = np.array([11, 0, 0, 1, 0]) * cover
        assert (units >= wanted).all()
        assert (units - wanted < few_skus.bundle_units).all()
        space = few_skus.bundle_space[found].tolist()
        assert space == sorted(space, reverse=True)
    assert bundles_to_cover(covered(tmp_path, 0.0), few_skus) == []


def test_the_cover_is_stored_before_anything_is_drawn(few_skus: SkuSet):
    capacity = np.full(20, 50.0)
    first = [0, 0, 3]
    stock = initial_stock(few_skus, capacity, 0.5, seed=1, first=first)
    assert stock.sku[:3].tolist() == first
    assert stock.share >= 0.5
    only = initial_stock(few_skus, capacity, 0.0, seed=1, first=first)
    assert only.sku.tolist() == first
    # what is drawn is the same bundles as without
    drawn = initial_stock(few_skus, capacity, 0.5, seed=1).sku.tolist()
    assert stock.sku[3:].tolist() == drawn[: len(stock.sku) - 3]


def test_a_cover_that_does_not_fit_is_refused(few_skus: SkuSet):
    told = r"order_cover: only \d+ of the 99 bundles .* all bundles take .* and the pods hold 60"
    with pytest.raises(InputError, match=told):
        initial_stock(few_skus, np.full(2, 30.0), 0.0, seed=1, first=[0] * 99)


def test_a_cover_needs_a_file_of_orders():
    with pytest.raises(InputError, match=r"stock\.order_cover needs a file"):
        scenario(stock={"order_cover": 1.0})


def test_a_run_with_a_cover_serves_every_order(tmp_path: Path):
    """Without replenishment and with nothing else in stock."""
    rows = [f"{k},O{k},S{k % 15},{1 + k % 4}" for k in range(60)]
    (tmp_path / "orders.csv").write_text("\n".join(["time,order,sku,quantity", *rows, ""]))
    (tmp_path / "own.toml").write_text(
        """format = "rmfs-scenario/1"
duration_s = 3600
warmup_s = 0
[skus]
file = "orders.csv"
[stock]
initial_share = 0.0
order_cover = 1.0
[demand]
mode = "stream"
file = "orders.csv"
[replenishment]
mode = "backlog"
bundles = 0
"""
    )
    done = rmfs.simulate("small", tmp_path / "own.toml", "default", seed=1)
    assert done.footprint["orders_completed"] == 60
    assert done.world.skus.names[:2] == ("S0", "S1")


def test_a_file_of_orders_is_a_table_of_skus(tmp_path: Path):
    path = tmp_path / "orders.csv"
    path.write_text("time,order,sku,quantity,customer\n0,A,SHOE,1,x\n0,A,HAT,9,x\n5,B,SHOE,1,y\n")
    found = sku_set(SkuFile(file=path))
    assert found.names == ("SHOE", "HAT")
    assert found.popularity.tolist() == [2.0, 1.0]
    path.write_text("time,order,sku,quantity\n0,A,40,1\n0,A,7,9\n5,B,40,1\n")
    assert sku_set(SkuFile(file=path)).ids.tolist() == [40, 7]
    path.write_text("time,order,sku,quantity\n0,A,40,1\n0,A,,9\n")
    with pytest.raises(InputError, match="line 3: sku must have 1 to 200 characters"):
        sku_set(SkuFile(file=path))
