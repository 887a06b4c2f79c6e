"""Results of a run on a file of bundles join with the file."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

import rmfs

SKUS = "sku,popularity\n" + "".join(f"S-{k},{k + 1}\n" for k in range(20))
ROWS = [(3.5 * k, f"S-{7 * k % 20}", 4 + k % 3, f"truck {k % 4}") for k in range(60)]


@pytest.fixture(scope="module")
def scenario(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("bundles")
    (folder / "skus.csv").write_text(SKUS)
    text = "".join(f"{time},{sku},{units},{truck}\n" for time, sku, units, truck in ROWS)
    (folder / "bundles.csv").write_text(f"time,sku,quantity,truck\n{text}")
    (folder / "own.toml").write_text(
        """format = "rmfs-scenario/1"
duration_s = 900
warmup_s = 0
[skus]
file = "skus.csv"
[stock]
initial_share = 0.3
[replenishment]
mode = "stream"
file = "bundles.csv"
"""
    )
    return folder / "own.toml"


def test_the_table_is_the_file_with_what_became_of_it(scenario: Path) -> None:
    done = rmfs.simulate("small", scenario, seed=1)
    lines, skus = done.table("bundle_lines"), done.table("skus")
    assert list(lines["file_line"]) == [k + 2 for k in range(len(ROWS))]
    assert list(lines["created_s"]) == [time for time, *_ in ROWS]
    assert list(lines["file_sku"]) == [sku for _, sku, *_ in ROWS]
    assert list(skus["name"].to_numpy()[lines["sku"]]) == [sku for _, sku, *_ in ROWS]
    assert list(lines["units"]) == [units for *_, units, _ in ROWS]
    assert list(lines["file_truck"]) == [truck for *_, truck in ROWS]
    stored = lines["stored_s"].notna()
    assert stored.sum() == done.footprint["bundles_stored"] > 5
    assert (lines["pod"][stored] >= 0).all()


def test_it_survives_a_folder_and_a_fork(scenario: Path, tmp_path: Path) -> None:
    done = rmfs.simulate("small", scenario, seed=1)
    saved = done.save(tmp_path / "run")
    pd.testing.assert_frame_equal(saved.table("bundle_lines"), done.table("bundle_lines"))
    simulation = rmfs.Simulation("small", scenario, seed=1)
    simulation.run_until(100.0)
    twin = simulation.fork()
    assert twin.arrivals.bundle_stream is simulation.arrivals.bundle_stream
    twin.run_until(900.0)
    forked = twin.result().table("bundle_lines")
    pd.testing.assert_frame_equal(forked, done.table("bundle_lines"))


def test_bundles_that_are_drawn_have_no_lines_in_a_file() -> None:
    drawn = rmfs.simulate("small", "small", seed=1, set={"scenario.duration_s": 300})
    assert drawn.table("bundle_lines").empty
