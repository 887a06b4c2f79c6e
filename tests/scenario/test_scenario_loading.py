"""Scenario files: the shipped ones, wrong ones, overrides and writing them back."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner

from rmfs.config import validate
from rmfs.errors import InputError
from rmfs.instances import names
from rmfs.scenario import Scenario, load, named_files, sku_set
from rmfs.scenario.commands import app
from rmfs.scenario.parameters import SkuFile
from rmfs.scenario.toml import to_toml

NAMES = ["basic", "default", "letters", "poisson", "pp-minimal", "shifts"]
HEAD = 'format = "rmfs-scenario/1"\nduration_s = 600\n'
XGENC = (
    "<SimpleItemGeneratorConfiguration><ItemDescriptions><A><Key>0</Key><Value>1</Value></A>"
    "</ItemDescriptions></SimpleItemGeneratorConfiguration>"
)


def written(folder: Path, body: str, head: str = HEAD) -> Path:
    path = folder / "mine.toml"
    path.write_text(head + body)
    return path


def problem(path: Path, overrides: list[tuple[list[str], object]] | None = None) -> str:
    with pytest.raises(InputError) as caught:
        load(path, overrides or [])
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert "\n" not in message
    return message.removeprefix(f"{path}: ")


def test_defaults_suffice(tmp_path: Path):
    scenario = load(written(tmp_path, ""))
    assert scenario.name == "mine"
    assert scenario.warmup_s == 3600
    assert len(sku_set(scenario.skus)) == 1000


@pytest.mark.parametrize("name", NAMES)
def test_shipped_scenarios_load(name: str):
    assert name in names("scenarios")
    scenario = load(name)
    assert scenario.name == name
    assert scenario.description
    assert load(name, [(["duration_s"], 7200)]).duration_s == 7200


def test_pp_minimal_has_single_unit_orders_of_equal_skus():
    scenario = load("pp-minimal")
    assert scenario.orders.lines.max == scenario.orders.units_per_line.max == 1
    assert (scenario.demand.orders, scenario.replenishment.bundles) == (100, 100)
    assert set(sku_set(scenario.skus).bundle_space.tolist()) == {1.0}


def test_a_misspelt_key_gets_the_nearest_one(tmp_path: Path):
    path = written(tmp_path, "warmup = 0\n[orders]\nlinse = {}\n")
    assert problem(path) == (
        "unknown key orders.linse; did you mean lines?; unknown key warmup; did you mean warmup_s?"
    )


def test_all_problems_come_at_once(tmp_path: Path):
    path = written(
        tmp_path,
        """
        warmup_s = -1
        [skus]
        popularity = { distribution = "gamma", shap = 1.0, scale = 0.0 }
        space_per_unit = { distribution = "uniform", min = 3.0, max = 2.0 }
        [orders]
        lines = { mean = 1.0, sd = 1.0, min = 4, max = 2, mx = 3 }
        [demand]
        orders = 1.5
        pause_below_share = 0.7
        [replenishment]
        mode = "poison"
        pause_above_share = 0.1
        """,
    )
    assert problem(path).split("; ") == [
        "warmup_s: Input should be greater than or equal to 0 (given: -1)",
        "skus.space_per_unit.max: must be at least min = 3 (given: 2.0)",
        "skus.popularity.shape: Field required",
        "skus.popularity.scale: Input should be greater than 0 (given: 0.0)",
        "unknown key skus.popularity.shap",
        "did you mean shape?",
        "orders.lines.max: must be at least min = 4 (given: 2)",
        "unknown key orders.lines.mx",
        "did you mean max?",
        "demand.orders: Input should be a valid integer (given: 1.5)",
        "demand.resume_above_share: must be at least pause_below_share = 0.7 (given: 0.6)",
        "replenishment.mode: must be one of 'backlog', 'poisson', 'needed', 'stream' "
        "(given: 'poison')",
    ]


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("[stock]\ninitial_share = 1.5", "stock.initial_share: Input should be less"),
        ("[skus]\ncount = 3", "orders: lines.max = 4 exceeds the 3 SKUs"),
        ('[skus]\npopularity = { distribution = "zipf" }', "distribution: must be one of 'const"),
        ("[skus]\npopularity = { shape = 1.0 }", "popularity.distribution: Field required"),
        ("[orders]\nlines = { mean = 9.0, sd = 0.0, min = 1, max = 4 }", "almost no count"),
        ("warmup_s = nan", "warmup_s: Input should be a finite number"),
        ('warmup_s = "60"', "warmup_s: Input should be a valid number"),
        ("warmup_s = true", "warmup_s: Input should be a valid number"),
        ("skus = 3", "skus: must be a table with keys such as affinity, "),
        (
            'orders = { lines = "many" }',
            "orders.lines: must be a table with keys such as distribution,",
        ),
        ("[skus", "not valid TOML"),
    ],
)
def test_wrong_values(tmp_path: Path, body: str, expected: str):
    assert expected in problem(written(tmp_path, body))


def test_another_format_is_refused(tmp_path: Path):
    path = written(tmp_path, 'format = "rmfs-layout/1"\nduration_s = 1', head="")
    assert problem(path) == "format: Input should be 'rmfs-scenario/1' (given: 'rmfs-layout/1')"


def test_no_such_scenario():
    with pytest.raises(InputError, match="did you mean default"):
        load("defualt")


def test_a_sku_file_is_relative_to_its_scenario(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    (tmp_path / "one.xgenc").write_text(XGENC)
    path = written(
        tmp_path,
        '[skus]\nfile = "one.xgenc"\n[orders]\nlines = {mean = 1.0, sd = 0.0, min = 1, max = 1}',
    )
    scenario = load(path)
    assert isinstance(scenario.skus, SkuFile)
    assert scenario.skus.file == tmp_path / "one.xgenc"
    assert len(sku_set(scenario.skus)) == 1
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(tmp_path)
    named = load(written(elsewhere, ""), [(["skus"], {"file": "one.xgenc"})])
    assert len(sku_set(named.skus)) == 1


def test_all_files_of_a_scenario_are_known(tmp_path: Path):
    (tmp_path / "one.xgenc").write_text(XGENC)
    (tmp_path / "b.csv").write_text("time,sku,quantity\n")
    lines = "[orders]\nlines = {mean = 1.0, sd = 0.0, min = 1, max = 1}\n"
    body = f'[skus]\nfile = "one.xgenc"\n{lines}[replenishment]\nmode = "stream"\nfile = "b.csv"'
    files = named_files(load(written(tmp_path, body)))
    assert files == {
        "skus.file": tmp_path / "one.xgenc",
        "replenishment.file": tmp_path / "b.csv",
    }
    assert named_files(load("default")) == {}
    assert named_files(load("letters"))["skus.words"].name == "words.txt"


def test_a_missing_sku_file(tmp_path: Path):
    path = written(tmp_path, '[skus]\nfile = "none.xgenc"')
    assert problem(path) == f"skus.file: no such file (given: '{tmp_path / 'none.xgenc'}')"


def test_a_sku_file_brings_its_own_number_of_skus(tmp_path: Path):
    (tmp_path / "one.xgenc").write_text(XGENC)
    path = written(tmp_path, '[skus]\nfile = "one.xgenc"\ncount = 5')
    assert problem(path).startswith("unknown key skus.count; valid: bundle_units, file")


@pytest.mark.parametrize("name", NAMES)
def test_a_scenario_survives_toml_and_json(name: str):
    scenario = load(name, [(["description"], 'a "b" \\ \x7f \n ü')])
    assert validate(Scenario, tomllib.loads(to_toml(scenario)), name) == scenario
    dumped = json.loads(json.dumps(scenario.model_dump(mode="json")))
    assert validate(Scenario, dumped, name) == scenario


def test_commands(tmp_path: Path):
    def run(*arguments: str) -> str:
        result = CliRunner().invoke(app, list(arguments), catch_exceptions=False)
        assert result.exit_code == 0
        return result.output

    assert "pp-minimal" in run("list")
    shown = run("show", "basic", "--set", "scenario.duration_s=7200")
    assert tomllib.loads(shown)["duration_s"] == 7200
    assert "# simulated time before measuring begins, s" in shown
    assert run("check", "default").startswith("default: ok, 1000 SKUs")
    with pytest.raises(InputError, match=r"expected a key such as scenario\.duration_s"):
        run("show", "basic", "--set", "duration_s=7200")
    (tmp_path / "one.xgenc").write_text(XGENC)
    few = written(tmp_path, '[skus]\nfile = "one.xgenc"')
    with pytest.raises(InputError, match=r"lines.max = 4 exceeds the 1 SKUs"):
        run("check", str(few))
