"""What the documentation claims is what is published, and what is published shows it."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path

import pytest

from rmfs.config import read_toml, validate
from rmfs.errors import InputError
from tests.tools.claims import SOURCE, ClaimFile, claims, main, page

ROOT = Path(__file__).resolve().parents[2]
PUBLISHED = ROOT / "results" / "published"

TABLE = "arm,seeds,units_per_h mean,units_per_h ±,gain difference,gain ±,p\nmany,10,612.5,3.25,30.0,2.0,0.01\n"  # noqa: E501


def source(folder: Path, **entry) -> Path:
    told = {"text": "Many pick", "file": "t.csv", "row": "many", "column": "units_per_h",
            "command": "python -m rmfs.experiments.papers.figure_4", **entry}  # fmt: skip
    lines = [f"{key} = {json.dumps(value)}" for key, value in told.items()]
    path = folder / "claims.toml"
    path.write_text('format = "rmfs-claims/1"\n[[claims]]\n' + "\n".join(lines) + "\n")
    return path


@pytest.fixture
def published(tmp_path):
    (tmp_path / "t.csv").write_text(TABLE)
    (tmp_path / "t.csv.provenance.json").write_text('{"design_hash": "0123456789abcdef"}')
    return tmp_path


def test_the_page_is_what_is_published(tmp_path):
    """Otherwise: python -m tests.tools.claims. Fails as soon as a published number changes."""
    assert main(["--published", str(PUBLISHED), "--page", str(tmp_path / "claims.md")]) == 0
    written = (tmp_path / "claims.md").read_text("utf-8")
    assert (ROOT / "docs" / "claims.md").read_text("utf-8") == written


def test_every_claim_names_a_command_that_exists():
    entries = validate(ClaimFile, read_toml(SOURCE), str(SOURCE)).claims
    for entry in entries:
        python, m, module, *_ = entry.command.split()
        assert (python, m) == ("python", "-m"), entry.command
        assert importlib.util.find_spec(module) is not None, entry.command


def test_a_claim_is_read_from_its_table(published):
    (found,) = claims(published, source(published))
    assert (found.value, found.half_width) == (612.5, 3.25)
    assert found.number == "612.5 ± 3.2"
    assert "| Many pick | 612.5 ± 3.2 | `python -m" in page([found])
    assert "`0123456789ab`" in page([found])
    (found,) = claims(published, source(published, column="gain"))
    assert found.number == "30.0 ± 2.0"
    (found,) = claims(published, source(published, column="p"))
    assert found.number == "0.01000"


@pytest.mark.parametrize(
    ("bounds", "holds"),
    [
        ({}, True),
        ({"above": 609.25}, True),
        ({"above": 609.3}, False),
        ({"below": 615.75}, True),
        ({"below": 615.7}, False),
    ],
)
def test_the_whole_interval_must_lie_within_the_claim(published, bounds, holds):
    (found,) = claims(published, source(published, **bounds))
    assert found.holds == holds
    if not holds:
        with pytest.raises(InputError, match=r"no longer shown .*: Many pick: 612\.5"):
            page([found])


@pytest.mark.parametrize(
    ("entry", "told"),
    [
        ({"file": "u.csv"}, r"u\.csv: cannot be read"),
        ({"row": "few"}, "few: is not there once; there are many"),
        ({"column": "orders"}, "orders: is not there once; there are seeds, units_per_h mean"),
        ({"value": 612.5}, "unknown key claims.0.value"),
    ],
)
def test_what_is_not_published_cannot_be_claimed(published, entry, told):
    with pytest.raises(InputError, match=told):
        claims(published, source(published, **entry))


def test_a_table_without_provenance_cannot_be_claimed(published, capsys):
    (published / "t.csv.provenance.json").write_text("{}")
    with pytest.raises(InputError, match="holds no design_hash"):
        claims(published, source(published))
    (published / "t.csv.provenance.json").unlink()
    with pytest.raises(InputError, match=r"provenance\.json: cannot be read"):
        claims(published, source(published))
    assert main(["--published", str(published)]) == 2
    assert "claims: " in capsys.readouterr().err
