"""Instances of the literature: the format of Valle and Beasley, an example with a known optimum."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rmfs.cli import main
from rmfs.errors import InputError
from rmfs.solvers.decisions.checking import check
from rmfs.solvers.decisions.files import read
from rmfs.solvers.decisions.racks import read_racks
from rmfs.solvers.decisions.solving import solve
from rmfs.solvers.models import sequencing
from rmfs.solvers.models.sequencing import Sequencing

TEXT = """\
N 6 # products
R 3
O 3
RS 2

Racks
Index Prod Qty
0 0 3 1 1
1 2 2 3 4
2 5 2 0 1

Orders
0 3 0 0 1
1 2 2 3
2 1 5
"""


def test_a_file_becomes_a_question(tmp_path: Path) -> None:
    path = tmp_path / "racks.txt"
    path.write_text(TEXT)
    question = read_racks(path, pickers=2, orders_each=1)
    assert question.data["units"].tolist() == [
        [2, 1, 0, 0, 0, 0],
        [0, 0, 1, 1, 0, 0],
        [0, 0, 0, 0, 0, 1],
    ]
    assert question.data["stock"][0].tolist() == [3, 1, 0, 0, 0, 0]
    found = solve(question, "cp_sat")
    assert check(question, found) == found.objective == 2.0


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        ("N 6", "M 6", "line 1: M: must be one of N, R, O, RS, or Racks"),
        ("R 3\n", "", "R: is missing"),
        ("R 3", "R 4", "Racks: must have the rows 0 to 3, each once"),
        ("R 3", "R three", "line 2: R: must be whole numbers"),
        ("0 0 3 1 1", "0 0 3 1 x", "line 8: Racks: must be whole numbers"),
        ("0 0 3 1 1", "0 0 3 1", "line 8: Racks: must have products from 0 to 5"),
        ("1 2 2 3\n2 1", "1 2 2 3 4\n2 1", "line 14: Orders: the number of products"),
        ("2 1 5", "2 1 6", "line 15: Orders: must have products from 0 to 5"),
        ("2 1 5", "1 1 5", "Orders: must have the rows 0 to 2, each once"),
    ],
)
def test_what_is_wrong_is_said_in_a_line(
    before: str, after: str, told: str, tmp_path: Path
) -> None:
    path = tmp_path / "racks.txt"
    assert before in TEXT
    path.write_text(TEXT.replace(before, after))
    with pytest.raises(InputError) as caught:
        read_racks(path, pickers=2, orders_each=1)
    assert told in str(caught.value)
    assert "\n" not in str(caught.value)


def test_the_command_writes_a_question(tmp_path: Path) -> None:
    path = tmp_path / "racks.txt"
    path.write_text(TEXT)
    given = ["decisions", "import", str(path), "--pickers", "3", "--out", str(tmp_path / "made")]
    assert main([*given, "--orders-each", "1"]) == 0
    (made,) = (tmp_path / "made").iterdir()
    assert read(made).data["slots"].tolist() == [1, 1, 1]
    assert main([*given, "--orders-each", "2"]) == 2
    with pytest.raises(InputError, match="3 orders are fewer than 3 x 2"):
        read_racks(path, pickers=3, orders_each=2)


def test_the_example_of_justkowiak_kovalyov_and_pesch_takes_four_visits() -> None:
    """Networks 84 (2024), section 2: eight orders, three racks, two orders at a time."""
    orders = [{4, 5}, {1, 2, 4}, {1, 2, 5}, {2, 3}, {1}, {1}, {2}, {1, 2, 3}]
    racks = [{2, 3}, {1, 4}, {5}]
    needs, holds = (
        np.array([[item in one for item in range(1, 6)] for one in many])
        for many in (orders, racks)
    )
    data = Sequencing(needs, holds, 2)
    for method in ("cp_sat", "dynamic"):
        found = sequencing.solve(data, method)
        assert found.objective == found.bound == 4.0
    assert sequencing.solve(data, "beam").objective == 4.0
