"""The tracked library: its table holds, small questions are proved, and it stays small."""

from __future__ import annotations

from collections import Counter

import pytest

from rmfs.instances import ROOT
from rmfs.solvers.decisions.checking import check
from rmfs.solvers.decisions.files import read
from rmfs.solvers.decisions.library.table import Library, questions
from rmfs.solvers.decisions.models import model_data
from rmfs.solvers.decisions.schema import SCHEMAS

FOLDER = ROOT / "decisions"
LARGEST_MB = 20.0


def assert_row_holds(library: Library, name: str) -> None:
    """Read a question and its best answer, and compare both with the table."""
    row = library.rows[name]
    decision = read(library.path(row))
    assert decision.name == name
    model_data(decision)
    assert decision.provenance["drawn"]["size"] == row.size
    answer = library.answer(row, decision)
    assert (answer is None) == (row.value_by == "")
    if answer is not None:
        value = check(decision, answer)
        assert value == row.value
        assert not (row.bound - value) * decision.sign > 1e-6 * max(1.0, abs(value))


def test_every_family_has_thirty_questions_and_the_small_ones_are_proved() -> None:
    library = Library.load(FOLDER)
    count = Counter(row.family for row in library.rows.values())
    assert set(count) == set(SCHEMAS)
    assert min(count.values()) >= 30
    small = [row for row in library.rows.values() if row.size == "small"]
    assert len(small) >= 10 * len(SCHEMAS)
    assert {row.status for row in small} == {"optimal"}
    assert {row.size for row in library.rows.values()} >= {"small", "medium", "real"}


def test_the_library_is_not_large() -> None:
    size = sum(path.stat().st_size for path in FOLDER.rglob("*") if path.is_file())
    assert size < LARGEST_MB * 1e6


@pytest.mark.parametrize("family", SCHEMAS)
def test_small_questions_and_answers_are_what_the_table_says(family: str) -> None:
    library = Library.load(FOLDER)
    for row in library.rows.values():
        if (row.family, row.size) == (family, "small"):
            assert_row_holds(library, row.question)


@pytest.mark.slow
def test_all_questions_and_answers_are_what_the_table_says() -> None:
    library = Library.load(FOLDER)
    assert set(library.rows) == {path.name.removesuffix(".json.gz") for path in questions(FOLDER)}
    for name in library.rows:
        assert_row_holds(library, name)
