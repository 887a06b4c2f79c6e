"""Spoilt numbers, names, files and options: exit code 2, one line, nothing left behind."""

from __future__ import annotations

import json
import re
import shutil
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rmfs.cli import main
from rmfs.layout import load
from rmfs.layout.explicit import save_json

RUN = ["run", "--layout", "small", "--scenario", "small", "--out", "out"]
SHORT = ["--set", "scenario.warmup_s=0", "--set", "scenario.duration_s=60"]
LIMIT_S = 60


@pytest.fixture(autouse=True)
def empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Work in an empty folder, and give up what does not end."""
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    signal.alarm(LIMIT_S)
    yield
    signal.alarm(0)


def refused(arguments: list[str], capsys: pytest.CaptureFixture[str], *files: str) -> str:
    """What a command says that is refused; nothing but the files given may be there after it."""
    assert main(arguments) == 2
    (line,) = [one for one in capsys.readouterr().err.splitlines() if one.strip()][-1:]
    assert line.startswith("rmfs: ") and "Traceback" not in line
    assert sorted(path.name for path in Path().iterdir()) == sorted(files)
    return line


NUMBERS = [
    *(
        f"layout.{key}={value}"
        for key in (
            *("acceleration_m_s2", "deceleration_m_s2", "top_speed_m_s", "full_turn_s"),
            *("pod_transfer_s", "unit_transfer_s", "unit_pick_s", "bundle_transfer_s"),
            *("pod_capacity", "order_slots", "horizontal_aisles", "vertical_aisles", "robots"),
            *("replenishment_station_capacity", "tier_height_m", "robot_radius_m"),
        )
        for value in ("1e308", "1e-308", "1e20", "nan", "-1")
    ),
    *(
        f"scenario.{key}={value}"
        for key in ("duration_s", "warmup_s", "skus.space_per_unit", "orders.urgent_offset_s")
        for value in ("1e308", "1e-308", "1e20", "nan", "-1")
    ),
    "scenario.disturbances.breakdowns={every_s=1e-9,lasting_s=1}",
    "layout.robots=" + "9" * 5000,
    "controllers.poa={name='pod-match',fast_lane='yes'}",
    "controllers.mm={name='scheduled'}",
]


@pytest.mark.parametrize("given", NUMBERS, ids=lambda given: given[:60])
def test_numbers_out_of_range(given: str, capsys) -> None:
    line = refused([*RUN, *SHORT, "--set", given], capsys)
    assert given.split("=")[0].split(".")[1].split("={")[0] in line


@pytest.mark.parametrize("seed", ["-1", "99999999999999999999", "9" * 5000])
def test_seeds(seed: str, capsys) -> None:
    assert "seed" in refused([*RUN, *SHORT, "--seed", seed], capsys)


@pytest.mark.parametrize(
    ("reference", "message"),
    [
        (":x", "no controller has this name"),
        (".x:y", "cannot be loaded|there is no module"),
        ("os:x", "has no class x|is no poa"),
        ("json:loads", "is no"),
        ("nothing.py:Y", "no file|no such file|cannot be"),
    ],
)
def test_references_that_lead_nowhere(reference: str, message: str, capsys) -> None:
    line = refused([*RUN, *SHORT, "--set", f"controllers.poa.name={reference}"], capsys)
    assert "poa.name" in line and re.search(message, line)


@pytest.mark.parametrize(
    "body",
    ["raise SystemExit(3)", "1 / 0", "import nothing_there", "def f(:", "raise BaseException"],
)
def test_modules_that_cannot_be_imported(body: str, capsys, monkeypatch) -> None:
    monkeypatch.setattr(sys, "dont_write_bytecode", True)  # only files of rmfs count as left behind
    Path("m.py").write_text(body)
    rule = ["--set", "controllers.poa.name=m.py:X"]
    refused([*RUN, *SHORT, *rule], capsys, "m.py")


FILES = {
    "nested.toml": "a = " + "[" * 2000 + "]" * 2000,
    "nested.json": "[" * 20_000 + "]" * 20_000,
    "digits.toml": "robots = " + "9" * 5000,
    "digits.json": '{"format": "rmfs-layout-explicit/1", "robots": ' + "9" * 5000 + "}",
    "empty.toml": "",
    "empty.json": "",
    "null.json": "null",
}


@pytest.mark.parametrize("name", FILES)
def test_layout_files(name: str, capsys) -> None:
    Path(name).write_text(FILES[name])
    assert name in refused(["run", "--layout", name, "--out", "out", *SHORT], capsys, name)


@pytest.mark.parametrize("option", ["--layout", "--scenario", "--controllers", "--out"])
def test_names_too_long_for_a_file(option: str, capsys) -> None:
    refused([*RUN, *SHORT, option, "x" * 5000], capsys)


@pytest.mark.parametrize("pacing", ["fixed", "replay", "fixed=-1", "wrok", "fixed=1e308"])
def test_pacing(pacing: str, capsys) -> None:
    rules = ["--controllers", "pile-on"]
    assert "pacing" in refused([*RUN, *SHORT, *rules, "--pacing", pacing], capsys)


EXPLICIT: dict[str, Callable[[Any], Any]] = {
    "x_m": lambda table: table["waypoints"][0].update(x_m=1e308),
    "robots": lambda table: table.update(robots=None),
    "pods": lambda table: table.update(pods=None),
    "order_slots": lambda table: table["pick_stations"][0].update(order_slots=10**30),
    "waypoints": lambda table: table.update(waypoints="a"),
    "pick stations": lambda table: table.update(pick_stations=[]),
    "replenishment stations": lambda table: table.update(replenishment_stations=[]),
}


@pytest.mark.parametrize("what", EXPLICIT)
def test_explicit_layouts(what: str, capsys) -> None:
    save_json(load("small"), Path("one.json"))
    table = json.loads(Path("one.json").read_text())
    EXPLICIT[what](table)
    Path("one.json").write_text(json.dumps(table))
    assert what in refused(["run", "--layout", "one.json", "--out", "out"], capsys, "one.json")
    assert main(["layout", "check", "one.json"]) == 2


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "one"
    assert main([*RUN[:-1], str(folder), *SHORT, "--trace"]) == 0
    return folder


@pytest.mark.parametrize("command", ["view", "report", "plot"])
@pytest.mark.parametrize("key", ["layout", "seed", "duration_s"])
def test_run_folders_without_a_key(command: str, key: str, run_folder: Path, capsys) -> None:
    shutil.copytree(run_folder, "run")
    told = json.loads(Path("run/run.json").read_text())
    del told[key]
    Path("run/run.json").write_text(json.dumps(told))
    options = ["--export", "page.html"] if command == "view" else []
    assert f"missing: {key}" in refused([command, "run", *options], capsys, "run")


def test_export_onto_a_folder(run_folder: Path, capsys) -> None:
    Path("page").mkdir()
    line = refused(["view", str(run_folder), "--export", "page"], capsys, "page")
    assert line.endswith("page: is a folder, not a file to write")


def test_export_makes_the_folder_it_needs(run_folder: Path) -> None:
    assert main(["view", str(run_folder), "--export", "new/page.html"]) == 0
    assert Path("new/page.html").stat().st_size > 10_000


def test_replay_of_a_run_that_asked_nobody(run_folder: Path, capsys) -> None:
    line = refused([*RUN, *SHORT, "--pacing", f"replay={run_folder}"], capsys)
    assert line.endswith("no optimiser was asked in that run")


@pytest.mark.parametrize("out", [".", "..", "../here", "/"])
def test_the_working_directory_is_not_replaced(out: str, capsys) -> None:
    assert "working directory" in refused([*RUN[:-1], out, *SHORT], capsys)


def test_a_column_of_arms_named_twice(capsys) -> None:
    Path("arms.csv").write_text("layout.robots,layout.robots\n4,6\n")
    head = 'format = "rmfs-design/1"\nname = "d"\nreplications = 1\narms_file = "arms.csv"\n'
    base = '[base]\nlayout = "small"\nscenario = "small"\ncontrollers = "default"\n'
    Path("d.toml").write_text(head + base)
    told = refused(["experiment", "plan", "d.toml"], capsys, "arms.csv", "d.toml")
    assert "names the column layout.robots more than once" in told
