"""`rmfs import`: a folder of RAWSim-O's files as files of ours."""

from __future__ import annotations

from pathlib import Path

import pytest
from rawsimo_files import XCONF, XITEM, XLAYO, xsett

from rmfs import control, layout, scenario
from rmfs.cli import main
from rmfs.measure import load_run
from rmfs.rawsimo.folder import LIST, import_files
from rmfs.scenario.skus.file import read_sku_set

REFERENCE = Path(__file__).resolve().parents[3] / "shared" / "reference" / "instances"


@pytest.fixture
def folder(tmp_path):
    """One file of each kind, and what is not one."""
    source = tmp_path / "theirs"
    (source / "deep").mkdir(parents=True)
    xsett(source / "scenarios", general="<Colour>red</Colour><HeatMode>x</HeatMode>")
    (source / "usual.xconf").write_text(XCONF)
    (source / "deep" / "small.XLAYO").write_text(XLAYO)
    (source / "readme.md").write_text("hello")
    return source


def test_each_kind_is_written_and_runs(folder, tmp_path, capsys):
    out = tmp_path / "ours"
    assert main(["import", str(folder), "--out", str(out)]) == 0
    assert {path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file()} == {
        LIST,
        "layouts/deep/small.toml",
        "scenarios/scenarios/test.toml",
        "scenarios/scenarios/test-skus.json",
        "skus/scenarios/Mu-1000.json",
        "skus/scenarios/list.json",
        "skus/scenarios/list-orders.csv",
        "skus/scenarios/list-bundles.csv",
        "controllers/usual.toml",
    }
    assert layout.load(str(out / "layouts/deep/small.toml")).robots == 4
    assert control.load(str(out / "controllers/usual.toml")).name == "usual"
    assert len(read_sku_set(out / "skus/scenarios/list.json")) == 2
    assert scenario.load(str(out / "scenarios/scenarios/test.toml")).duration_s == 172800
    capsys.readouterr()
    run = tmp_path / "run"
    parts = {"layout": "layouts/deep/small", "scenario": "scenarios/scenarios/test"}
    given = [word for part, name in parts.items() for word in (f"--{part}", f"{out / name}.toml")]
    more = ["--controllers", f"{out}/controllers/usual.toml", "--set", "scenario.duration_s=300"]
    assert main(["run", *given, *more, "--out", str(run)]) == 0
    assert load_run(run).footprint["units_picked"] > 0


def test_all_is_listed(folder, tmp_path, capsys):
    out = tmp_path / "ours"
    (folder / "broken.xinst").write_text("<Instance>")
    # one of the files is refused, which the exit code says; the others are there
    assert main(["import", str(folder), "--out", str(out)]) == 2
    printed = capsys.readouterr().out
    for line in (
        "broken.xinst: explicit layout, refused: not a complete XML file",
        "deep/small.XLAYO: parameters of a layout, written as layouts/deep/small.toml",
        "  CollisionPenaltyTime is not used: robots never collide in rmfs",
        "readme.md: skipped, as it is not a RAWSim-O file that can be imported",
        "  HeatMode not used: RAWSim-O no longer supports it",
        "  Colour unknown, left out",
        "  has no space per unit: drawn",
        "list.xitem: list of orders and bundles, written as skus/scenarios/list.json, "
        "skus/scenarios/list-orders.csv",
    ):
        assert line in printed
        words = line.strip()
        assert words in (out / LIST).read_text()
    assert not list(out.rglob("broken*"))
    assert (out / LIST).read_text().startswith("# Imported from theirs\n\n- broken.xinst")


def test_a_single_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "usual.xconf"
    path.write_text(XCONF)
    assert main(["import", str(path)]) == 0
    assert Path("results/imported/usual/controllers/usual.toml").is_file()


def test_an_import_can_be_repeated_and_strangers_are_left_alone(folder, tmp_path):
    out = tmp_path / "ours"
    import_files(folder, out)
    before = {path: path.read_bytes() for path in out.rglob("*") if path.is_file()}
    import_files(folder, out)
    assert before == {path: path.read_bytes() for path in out.rglob("*") if path.is_file()}
    (out / LIST).unlink()
    assert main(["import", str(folder), "--out", str(out)]) == 2
    assert len(list(out.rglob("*.toml"))) == 3


@pytest.mark.parametrize("what", ["missing", "empty", "strange", "refused"])
def test_nothing_to_import_is_one_line_and_leaves_nothing(what, tmp_path, capsys):
    source, out = tmp_path / "theirs", tmp_path / "ours" / "below"
    if what != "missing":
        source.mkdir()
    if what == "strange":
        (source / "notes.txt").write_text("hello")
    if what == "refused":
        (source / "orders.xitem").write_text(XITEM.replace('Count="2"', 'Count="-2"'))
    assert main(["import", str(source), "--out", str(out)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert str(source) in line
    assert not out.parent.exists()


def test_two_files_that_would_make_the_same_one(tmp_path):
    for name in ("a.xlayo", "a.XLAYO"):
        (tmp_path / "theirs").mkdir(exist_ok=True)
        (tmp_path / "theirs" / name).write_text(XLAYO)
    first, second = import_files(tmp_path / "theirs", tmp_path / "ours")
    assert first.written == [Path("layouts/a.toml")]
    assert "another file was already imported as layouts/a.toml" in second.refused


@pytest.mark.slow
def test_the_published_files(tmp_path):
    """All of them are ours afterwards, and say what they said before."""
    if not REFERENCE.is_dir():
        pytest.skip("the reference instances are not here")
    done = import_files(REFERENCE, tmp_path / "ours")
    assert [one for one in done if one.refused] == []
    known = [one for one in done if one.kind]
    assert len(known) > 70
    for one in known:
        given, ours = REFERENCE / one.source, str(tmp_path / "ours" / one.written[0])
        if given.suffix == ".xconf":
            assert control.load(ours) == control.load(str(given))
        elif given.suffix in (".xinst", ".xlayo"):
            assert layout.load(ours).robots == layout.load(str(given)).robots
        elif given.suffix == ".xsett":
            theirs, made = scenario.load(given), scenario.load(ours)
            assert (made.duration_s, made.orders) == (theirs.duration_s, theirs.orders)
            assert type(made.replenishment) is type(theirs.replenishment)
