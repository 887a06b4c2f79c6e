"""Tables as LaTeX sets them; pictures say which table they show."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from rmfs.errors import InputError
from rmfs.experiments.tables import Table
from tests.tools import typeset

ROOT = Path(__file__).resolve().parents[2]
PUBLISHED = sorted((ROOT / "results" / "published").glob("*.tex"))
SHOWN = {"figure-5a.tex": ROOT / "docs" / "images" / "figure-5a-table.png"}
TABLE = r"\begin{tabular}{lS[table-format=2.1]} \toprule {a} & {b} \\ \midrule x & 12.5 \\ \bottomrule \end{tabular}"  # noqa: E501

latex = pytest.mark.skipif(typeset.engine() is None, reason="no LaTeX here")


@pytest.mark.parametrize(("table", "picture"), SHOWN.items())
def test_the_picture_in_the_documentation_is_that_of_the_published_table(table, picture):
    text = (ROOT / "results" / "published" / table).read_text(encoding="utf-8")
    assert typeset.shown_by(picture) == typeset.digest(text)


@pytest.mark.slow
@latex
@pytest.mark.parametrize("path", PUBLISHED, ids=lambda path: path.name)
def test_every_published_table_compiles(path, tmp_path):
    assert typeset.compiled(path.read_text(encoding="utf-8"), tmp_path).stat().st_size > 1000


@pytest.mark.slow
@latex
def test_a_picture_is_drawn_and_carries_the_hash_of_its_table(tmp_path):
    from PIL import Image

    (tmp_path / "t.tex").write_text(TABLE)
    assert typeset.main([str(tmp_path / "t.tex"), str(tmp_path / "t.png")]) == 0
    assert typeset.shown_by(tmp_path / "t.png") == typeset.digest(TABLE)
    with Image.open(tmp_path / "t.png") as image:
        assert image.width > 60 and image.height > 30


@pytest.mark.slow
@latex
def test_what_latex_does_not_understand_is_one_line(tmp_path, capsys):
    (tmp_path / "t.tex").write_text(r"\nonsense{1}")
    assert typeset.main([str(tmp_path / "t.tex"), str(tmp_path / "t.png")]) == 2
    told = capsys.readouterr().err
    assert "Undefined control sequence" in told and len(told.splitlines()) == 1
    assert not (tmp_path / "t.png").exists()


def test_without_latex_this_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr("shutil.which", lambda name: None)
    with pytest.raises(InputError, match="needs one of tectonic, pdflatex"):
        typeset.compiled(TABLE, tmp_path)


def test_a_missing_table_is_told(tmp_path, capsys):
    assert typeset.main([str(tmp_path / "t.tex"), str(tmp_path / "t.png")]) == 2
    assert "t.tex: cannot be read (No such file or directory)" in capsys.readouterr().err


@pytest.mark.slow
@latex
def test_arms_and_captions_may_hold_any_sign(tmp_path):
    from rmfs.experiments.tables import means

    arm = r"a_b%c&d#e$f{g}h\i~j^k<l>m"
    frame = pd.DataFrame({"arm": arm, "replication": [1, 2], "units_per_h": [1.0, 2.0]})
    table = means(frame, ["units_per_h"])
    named = Table(table.frame, table.decimals, f"Arm minus {arm}.")
    assert typeset.compiled(named.latex(), tmp_path).is_file()
    grouped = table.frame.set_axis(pd.MultiIndex.from_tuples([(arm, arm)], names=[arm, "b, %"]))
    grouped["theirs", "over 100 %"] = 1.0
    assert typeset.compiled(Table(grouped, table.decimals, "").latex(), tmp_path).is_file()
