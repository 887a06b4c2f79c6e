"""`rmfs layout new | show | check | import`."""

from __future__ import annotations

import json
import os
import stat

import pytest
from layout_reference import INSTANCES, needs_reference
from typer.testing import CliRunner

from rmfs import instances
from rmfs.config import read_toml, validate
from rmfs.errors import InputError
from rmfs.layout import LayoutParameters, generate, load, save_json
from rmfs.layout.commands import app


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def refused(*arguments):
    """Return the message of the input error that a command raises for the CLI to print."""
    result = run(*arguments)
    assert isinstance(result.exception, InputError), result.output
    return str(result.exception)


def test_new_writes_all_parameters(tmp_path):
    path = tmp_path / "mine.toml"
    result = run("new", path, "--set", "robots=16", "--set", "layout.pick_stations.east=2")
    assert result.exit_code == 0
    parameters = validate(LayoutParameters, read_toml(path), "mine")
    expected = LayoutParameters(
        name="mine", robots=16, pick_stations={"east": 2}, replenishment_stations={"west": 4}
    )
    assert parameters == expected
    assert "# duration of lifting or setting down a pod, s" in path.read_text()


def test_new_replaces_no_file_unless_told(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("precious")
    assert "--force replaces it" in refused("new", path)
    assert path.read_text() == "precious"
    assert run("new", path, "--force").exit_code == 0


def test_new_never_takes_the_place_of_a_device_or_a_pipe(tmp_path):
    pipe = tmp_path / "pipe.toml"
    os.mkfifo(pipe)
    assert "pipe.toml: is a device or a pipe" in refused("new", pipe, "--force")
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    assert list(tmp_path.iterdir()) == [pipe]


def test_a_file_is_not_a_folder_to_write_in(tmp_path):
    (tmp_path / "file").write_text("")
    assert f"({tmp_path / 'file'} is not a folder)" in refused("new", tmp_path / "file" / "a.toml")


def test_new_refuses_wrong_parameters_and_writes_nothing(tmp_path):
    path = tmp_path / "mine.toml"
    assert "did you mean robots?" in refused("new", path, "--set", "robts=16")
    assert "must end in .toml" in refused("new", tmp_path / "mine.json")
    assert list(tmp_path.iterdir()) == []


def test_show_writes_a_picture(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run("show", "default").exit_code == 0
    assert (tmp_path / "default.svg").stat().st_size > 10_000
    assert run("show", "basic", "--arrows", "--out", "some/basic.png").exit_code == 0
    assert (tmp_path / "some/basic.png").stat().st_size > 10_000


def test_check_of_a_good_layout():
    result = run("check", "default", "--set", "robots=96")
    assert result.exit_code == 0
    assert "default: well-formed: 1472 waypoints, 3934 edges" in result.output
    assert "96 robots" in result.output


def test_check_prints_violations_and_exits_with_2(tmp_path):
    path = tmp_path / "layout.json"
    save_json(generate(LayoutParameters()), path)
    table = json.loads(path.read_text())
    entrance = table["pick_stations"][0]["queue"][-1]
    for waypoint in table["waypoints"]:
        waypoint["to"] = [head for head in waypoint["to"] if head != entrance]
    path.write_text(json.dumps(table))
    result = run("check", path)
    assert result.exit_code == 2
    assert "not well-formed: pick station 0" in result.output
    assert run("check", path, "--allow-not-well-formed").exit_code == 0

    head = table["pick_stations"][0]["queue"][0]
    for waypoint in table["waypoints"]:
        waypoint["to"] = [target for target in waypoint["to"] if target != head]
    path.write_text(json.dumps(table))
    assert run("check", path, "--allow-not-well-formed").exit_code == 2


def test_check_of_a_missing_layout():
    assert "no shipped layouts of that name" in refused("check", "none-such")


@needs_reference
def test_import_of_an_instance(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    source = INSTANCES / "core/1-3-3-15-64.xinst"
    result = run("import", source)
    assert result.exit_code == 0
    assert "note: 3 pick stations have no ItemPickTime" in result.output
    assert load(tmp_path / "1-3-3-15-64.json").waypoints == load(source).waypoints
    assert "--force replaces it" in refused("import", source)


@needs_reference
def test_import_of_parameters(tmp_path):
    out = tmp_path / "small.toml"
    result = run("import", INSTANCES / "repositioning/RepoSmall.xlayo", "--out", out)
    assert result.exit_code == 0
    assert load(out).waypoints == 1744


@pytest.mark.parametrize("name", ["a.txt", "a.json"])
def test_import_of_something_else(name, tmp_path):
    assert "expected a .xinst or .xlayo file" in refused("import", tmp_path / name)


def test_shipped_layouts_are_listed():
    listed = CliRunner().invoke(app, ["list"])
    rows = [line.split() for line in listed.output.splitlines()]
    assert ["small", "1", "10", "100", "2", "2", "448"] in rows
    assert [row[0] for row in rows[1:]] == instances.names("layouts")
