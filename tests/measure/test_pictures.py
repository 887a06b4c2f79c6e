"""Pictures, reports and CSV of a run folder, through the command line."""

from __future__ import annotations

import re

import pytest
from fake_run import run
from matplotlib.figure import Figure

from rmfs.cli import main
from rmfs.measure import load_run, plots, write_run
from rmfs.measure.dictionary import TABLES
from rmfs.measure.pictures import PICTURES, picture


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    target = tmp_path_factory.mktemp("runs") / "run"
    told = run()
    told.names = ("<script>alert(1)</script>", "fake-scenario", "fake-controllers")
    write_run(told, target)
    return target


@pytest.mark.parametrize("what", PICTURES)
def test_every_picture_can_be_drawn(folder, what, capsys, tmp_path):
    assert main(["plot", str(folder), "--what", what, "--out", str(tmp_path)]) == 0
    (file,) = tmp_path.iterdir()
    assert capsys.readouterr().out.split() == [str(file)]
    assert file.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("column", ["loaded_visits", "pick_visits", "store_waiting_s"])
def test_heat_by_task_and_by_load(folder, tmp_path, column):
    assert main(["plot", str(folder), "--what", f"heat:{column}", "--out", str(tmp_path)]) == 0
    (file,) = tmp_path.iterdir()
    assert file.name == f"heat-{column}.png"
    figure = picture(load_run(folder), f"heat:{column}")
    meaning = {one.name: one.meaning for one in TABLES["heat"]}[column]
    counts = load_run(folder).table("heat")[column]
    drawn = [len(c.get_paths()) for c in figure.axes[0].collections]
    assert drawn[-1] == (counts > 0).sum() or not counts.any()
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert not counts.any() or any(label.startswith(meaning.split(",")[0]) for label in labels)


@pytest.mark.parametrize(("suffix", "begin"), [("svg", b"<?xml"), ("pdf", b"%PDF")])
def test_the_same_run_gives_the_same_file(folder, tmp_path, suffix, begin):
    for name in ("one", "other"):
        arguments = ["plot", str(folder), "--what", "backlog", "--format", suffix]
        assert main([*arguments, "--out", str(tmp_path / name)]) == 0
    one, other = ((tmp_path / name / f"backlog.{suffix}").read_bytes() for name in ("one", "other"))
    assert one == other
    assert one.startswith(begin)


def test_functions_draw_into_axes_and_return_nothing(folder):
    read = load_run(folder)
    for table, draw, _ in PICTURES.values():
        ax = Figure().add_subplot()
        assert draw(read.table(table), ax) is None
        assert ax.get_xlabel()


def test_progression_is_in_units_and_km_per_hour(folder):
    ax = Figure().add_subplot()
    plots.progression(load_run(folder).table("series"), ax, bin_s=60.0)
    units, driven = ax.lines[0], ax.figure.axes[1].lines[0]
    assert units.get_ydata()[:3].tolist() == pytest.approx([60.0, 60.0, 0.0])
    # two robots, 1 m/s each
    assert driven.get_ydata() == pytest.approx(7.2)
    assert units.get_xdata()[0] * 3600 == pytest.approx(130.0)


def test_the_bound_is_drawn_where_there_is_one(folder):
    series = load_run(folder).table("series")
    for bound, lines in ((738.0, 2), (float("inf"), 1), (None, 1)):
        ax = Figure().add_subplot()
        plots.progression(series, ax, bound_per_h=bound)
        assert len(ax.lines) == lines
        assert bound != 738.0 or ax.get_ylim()[1] > 738.0


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["--what", "colour"], "valid: progression, heat"),
        (["--what", "backlog:visits"], "valid: progression, heat"),
        (["--what", "heat:colour"], "valid: visits, loaded_visits"),
        (["--format", "gif", "--what", "heat"], "png, svg, pdf"),
    ],
)
def test_wrong_names_are_one_line(folder, capsys, arguments, text):
    assert main(["plot", str(folder), *arguments]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert text in line


def test_a_report_is_one_file_that_needs_nothing_else(folder, tmp_path, capsys):
    target = tmp_path / "report.html"
    assert main(["report", str(folder), "--out", str(target)]) == 0
    text = target.read_text(encoding="utf-8")
    assert text.count("data:image/png;base64,") == len(PICTURES)
    assert "prefers-color-scheme: dark" in text
    # nothing is fetched, nothing is run, names are escaped
    assert not re.search(r'(src|href)="(?!data:)', text)
    assert "<script" not in text
    assert "&lt;script&gt;" in text
    assert all(f"<td>{column.name}</td>" in text for column in TABLES["footprint"])
    assert "Provenance" in text


def test_csv_on_demand(folder, tmp_path):
    assert main(["report", str(folder), "--out", str(tmp_path / "r.html"), "--csv"]) == 0
    for name in TABLES:
        header = (folder / f"{name}.csv").read_text().splitlines()[0]
        assert header.split(",") == [column.name for column in TABLES[name]]


def test_a_folder_without_a_run_is_one_line(tmp_path, capsys):
    for command in ("plot", "report"):
        assert main([command, str(tmp_path)]) == 2
        assert "not a run folder" in capsys.readouterr().err
