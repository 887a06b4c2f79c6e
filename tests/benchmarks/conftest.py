"""The table of models that `make bench` writes: what it took to build and to solve each."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd
import pytest

if TYPE_CHECKING:
    from collections.abc import Callable

TABLE = Path("results") / "published" / "models.csv"
KEY = ["model", "size", "method"]
_ROWS: list[dict[str, Any]] = []


@pytest.fixture
def note(benchmark: Any) -> Callable[..., None]:
    """Write down what the table shows of a solution: `note(model, size, method, solution, what)`.

    At the large size building may take no longer than solving, whatever the model.
    """

    def write(model: str, size: str, method: str, solution: Any, what: str) -> None:
        if benchmark.disabled:
            return
        found = {
            "model": model,
            "size": size,
            "what": what,
            "method": method,
            "build ms": 1e3 * solution.build_s,
            "solve ms": 1e3 * solution.solve_s,
            "median ms": 1e3 * benchmark.stats.stats.median,
            "gap %": round(100.0 * solution.gap, 4),
            "status": solution.status.value,
            "work": solution.work,
        }
        benchmark.extra_info |= found
        _ROWS.append(found)
        assert size != "large" or solution.build_s <= solution.solve_s, found

    return write


def pytest_sessionfinish() -> None:
    """Replace the rows that were measured anew, and keep the others."""
    if not _ROWS:
        return
    made = pd.DataFrame(_ROWS)
    if TABLE.is_file():
        made = pd.concat([pd.read_csv(TABLE), made]).drop_duplicates(KEY, keep="last")
    size = pd.CategoricalIndex(made["size"], ["small", "medium", "large"], ordered=True)
    made = made.assign(order=size).sort_values(["model", "method", "order"], kind="stable")
    made = made.drop(columns="order")
    TABLE.parent.mkdir(parents=True, exist_ok=True)
    for path, text in (
        (TABLE, made.to_csv(index=False, float_format="%.4g")),
        (TABLE.with_suffix(".md"), made.to_markdown(index=False, floatfmt=".3g") + "\n"),
    ):
        new = path.with_name(f".{path.name}")
        new.write_text(text)
        new.replace(path)
