"""`rmfs scenario`: import, SKU sets, export, and files of RAWSim-O in place of ours."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
from rawsimo_files import XITEM
from rawsimo_files import xsett as xsett_file
from scenario_tools import DAY_US, SITE, FakeState, drive
from typer.testing import CliRunner

from rmfs.config import validate
from rmfs.errors import InputError
from rmfs.scenario import Scenario, bundle_intake, load, order_intake, sku_set, sources
from rmfs.scenario.commands import app
from rmfs.scenario.loading import load_with_notes


def read(folder: Path, inventory: str = "", general: str = "") -> tuple[Scenario, list[str]]:
    """Write a settings file with its SKUs, words and order list beside it, and read it."""
    return load_with_notes(xsett_file(folder, general=general, inventory=inventory))


def run(*arguments: object) -> str:
    result = CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)
    assert result.exit_code == 0
    return result.output


def test_import_writes_a_scenario_that_needs_no_other_files(tmp_path: Path):
    source, target = tmp_path / "source", tmp_path / "target/mine.toml"
    source.mkdir()
    fixed = "<FixedInventoryConfiguration><OrderFile>list.xitem</OrderFile>"
    cases = {
        "simple": "",
        "letters": "<ItemType>Letter</ItemType><ColoredWordConfiguration><WordFile>Small.txt"
        "</WordFile></ColoredWordConfiguration>",
        "fixed": f"<OrderMode>Fixed</OrderMode>{fixed}</FixedInventoryConfiguration>",
        "poisson": "<OrderMode>Poisson</OrderMode>",
    }
    for name, inventory in cases.items():
        imported, _ = read(source, inventory, "<Moon>full</Moon>")
        output = run("import", source / "test.xsett", "--out", target, "--force")
        assert f"{target}: written" in output
        assert "note: Moon unknown" in output
        again = load(target)
        assert tomllib.loads(target.read_text())["name"] == "test"
        skus = sku_set(imported.skus)
        assert sku_set(again.skus).digest() == skus.digest(), name
        for intake_of in (order_intake, bundle_intake):
            come = [
                drive(intake_of(given, skus, SITE, 1), FakeState(len(skus)), DAY_US)
                for given in (imported, again)
            ]
            assert come[0] == come[1], name
    with pytest.raises(InputError, match="exists already; --force replaces it"):
        run("import", source / "test.xsett", "--out", target)
    with pytest.raises(InputError, match=r"expected a \.xsett file"):
        run("import", target)


def test_a_settings_file_serves_wherever_a_scenario_does(tmp_path: Path):
    read(tmp_path)
    path = tmp_path / "test.xsett"
    shown = run("show", path, "--set", "scenario.duration_s=60")
    table = tomllib.loads(shown[shown.index("format") :])
    assert validate(Scenario, table, "shown").duration_s == 60
    assert "ok, 9 SKUs" in run("check", path)


def test_sku_sets_from_the_command_line(tmp_path: Path):
    (tmp_path / "list.xitem").write_text(XITEM)
    out, picture = tmp_path / "skus.json", tmp_path / "curve.svg"
    told = run("sku-set", tmp_path / "list.xitem", "--out", out, "--picture", picture)
    assert "2 SKUs" in told
    assert picture.read_text().startswith("<?xml")
    assert run("sku-set", out).split("digest ")[1] == told.split("digest ")[1].split("\n")[0] + "\n"
    assert "1000 SKUs" in run("sku-set", "default", "--set", "scenario.skus.seed=4")
    with pytest.raises(InputError, match="exists already"):
        run("sku-set", "default", "--out", out)
    with pytest.raises(InputError, match=r"none\.json: no such file"):
        run("sku-set", tmp_path / "none.json")


def test_check_reads_a_file_of_orders_once(tmp_path: Path, monkeypatch):
    read, readings = sources.read_orders, []
    monkeypatch.setattr(sources, "read_orders", lambda *a: readings.append(a[0]) or read(*a))
    path = tmp_path / "orders.csv"
    path.write_text("time,order,sku,quantity\n0,a,1,1\n9,b,2,1\n")
    stream = f"scenario.demand={{mode='stream', file='{path}'}}"
    assert "2 orders, digest" in run("check", "small", "--set", stream)
    assert readings == [path]


def test_export_from_the_command_line(tmp_path: Path):
    path = tmp_path / "orders.csv"
    told = run("export", "poisson", path, "--seed", 3, "--set", "scenario.duration_s=60")
    digest = told.rsplit(" ", 1)[1].strip()
    replay = ["--set", f"scenario.demand={{mode='stream', file='{path}', digest='{digest}'}}"]
    assert f"orders, digest {digest}" in run("check", "default", *replay)
    bundles = tmp_path / "bundles.parquet"
    poisson = "scenario.replenishment={mode='poisson'}"
    assert "bundles, digest" in run(
        "export", "default", bundles, "--what", "bundles", "--set", poisson
    )
    stream = f"scenario.replenishment={{mode='stream', file='{bundles}'}}"
    assert "bundles, digest" in run("check", "default", "--set", stream)
    with pytest.raises(InputError, match="default: demand: orders that depend"):
        run("export", "default", tmp_path / "none.csv")
