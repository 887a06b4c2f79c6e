"""The library of decisions: best known values, and a comparison of solvers.

A question asks an optimiser to take one decision; questions of the same kind form a family (docs:
decisions). The study publishes, by family and size of the questions, how many best known values are
proven optimal, and how far the answers given in runs are from the best known values. It also
compares solution methods, based on the times in `decision-times.csv`. With `--time`, these times
are first measured: for each family in `TIMED`, every method answers some questions under several
limits of work, as in `rmfs decisions profile`. The other families are not timed, because all their
best known values are proven optimal.
"""

from __future__ import annotations

import argparse
import json
import math
import platform
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from rmfs.experiments.figures.style import saving
from rmfs.experiments.papers.study import PUBLISHED, command
from rmfs.experiments.provenance import FORMAT, SUFFIX
from rmfs.experiments.provenance import command as called
from rmfs.experiments.running.code import code
from rmfs.files import write_text
from rmfs.instances import ROOT
from rmfs.measure.provenance import commit
from rmfs.solvers.decisions.files import read
from rmfs.solvers.decisions.library.table import Library
from rmfs.solvers.decisions.profiling import points, primal_gap
from rmfs.solvers.decisions.ranking import (
    data_profile,
    integrals,
    performance,
    times_to_gap,
    with_gaps,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.axes import Axes

LIBRARY = ROOT / "decisions"
SOLVED = 0.01
"""Largest primal gap at which a question counts as solved in the profiles."""

TIMED: dict[str, dict[str, float]] = {
    "pile_on": {"greedy": 1, "hadgs": 64, "joint": 0.512, "neighbourhood": 0.512, "cp_sat": 0.512},
    "planning": {"greedy": 1, "lns": 256},
    "sequencing": {"beam": 256, "cp_sat": 0.512},
    "rack_allocation": {"greedy": 1, "cp_sat": 0.512},
    "stays": {"greedy": 1, "cp_sat": 0.512, "highs": 4},
    "sequence": {"greedy": 1, "lns": 16384, "columns": 1.024, "cp_sat": 0.512},
    "replenishment": {"greedy": 1, "rounding": 1, "cp_sat": 0.512, "highs": 4},
}
"""Methods to time by family, each with its largest limit of work (in the unit of the method)."""

RATIOS = [2.0 ** (step / 4) for step in range(33)]
SECONDS = [10.0 ** (step / 8 - 3) for step in range(33)]


def main(arguments: list[str] | None = None) -> None:
    """Time the methods if `--time` is given, and publish the tables and pictures."""
    made = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    made.add_argument("--library", type=Path, default=LIBRARY, help="folder of the library")
    made.add_argument("--published", type=Path, default=PUBLISHED, help="folder of tables")
    made.add_argument("--time", action="store_true", help="time methods first")
    made.add_argument(
        "--questions",
        type=int,
        default=2,
        help="number of questions of each family and size to time",
    )
    made.add_argument("--seeds", type=int, default=2, help="number of seeds of each method to time")
    made.add_argument("--size", action="append", help="sizes to time (default: small and real)")
    made.add_argument("--family", action="append", help="families to time (default: all)")
    given = made.parse_args(arguments)
    library = Library.load(given.library)
    rows = given.published / "decision-times.csv"
    if given.time:
        sizes = given.size or ["small", "real"]
        families = given.family or list(TIMED)
        timed = pd.DataFrame(_timed(library, families, sizes, given.questions, given.seeds))
        if rows.exists():  # what is not timed now stays
            before = pd.read_csv(rows)
            timed = pd.concat([before[~before["family"].isin(families)], timed])
        _publish(rows, timed.to_csv(index=False), machine=platform.processor() or "unknown")
    known = library.frame()
    publish_table(given.published / "decision-library.md", state(known))
    publish_table(given.published / "decision-online.md", online(library))
    if rows.exists():
        best = dict(zip(known["question"], known["value"], strict=True))
        table = with_gaps(pd.read_csv(rows), best)
        source = f"of {rows.name}"
        publish_table(given.published / "decision-integrals.md", compared(table), source=source)
        for name in ("performance", "data"):
            path = given.published / f"decision-{name}.png"
            _picture(path, table, name)
            _record(path, source=source, solved_at_gap=SOLVED)


def state(known: pd.DataFrame) -> pd.DataFrame:
    """Return numbers of questions and of proven optima, and gaps to bounds, by family and size.

    Parameters
    ----------
    known
        Table of the questions and their best known values, as `Library.frame` returns it.
    """
    groups = known.groupby(["family", "size"], sort=False)
    found = pd.DataFrame(
        {
            "questions": groups.size(),
            "proved": groups["status"].agg(lambda one: int((one == "optimal").sum())),
            "without bound": groups["gap"].agg(lambda one: int(one.isna().sum())),
            "median gap": groups["gap"].median().map("{:.2%}".format),
            "largest gap": groups["gap"].max().map("{:.2%}".format),
        }
    )
    return _by_size(found)


def online(library: Library) -> pd.DataFrame:
    """Return gaps between answers given in runs and best known values, by family and size.

    In the runs, the controllers' limits of work applied.

    Parameters
    ----------
    library
        The library of questions.
    """
    rows = []
    for row in library.rows.values():
        decision = read(library.path(row))
        if decision.recorded is not None and not math.isnan(row.value):
            value = decision.recorded.objective
            rows.append(
                {
                    "family": row.family,
                    "size": row.size,
                    "gap": primal_gap(value, row.value),
                    "apart": abs(value - row.value),
                }
            )
    groups = pd.DataFrame(rows).groupby(["family", "size"], sort=False)
    found = pd.DataFrame(
        {
            "questions": groups.size(),
            "median gap": groups["gap"].median().map("{:.2%}".format),
            "mean gap": groups["gap"].mean().map("{:.2%}".format),
            "largest gap": groups["gap"].max().map("{:.2%}".format),
            "median distance": groups["apart"].median().map("{:.3g}".format),
        }
    )
    return _by_size(found)


def compared(table: pd.DataFrame) -> pd.DataFrame:
    """Return mean primal integrals (docs: decisions) and times, by family, size and method.

    Parameters
    ----------
    table
        Timed answers, as `with_gaps` returns them, with the additional column `size`.
    """
    areas = integrals(table)
    areas["size"] = areas["question"].map(table.groupby("question")["size"].first())
    last = table.sort_values("work_limit").groupby(["question", "method", "seed"]).last()
    keys = ["family", "size", "method"]
    groups = areas.groupby(keys, sort=False)
    spread = areas.groupby([*keys, "question"])["over_wall"].std().groupby(keys).mean()
    ends = last.groupby(keys)
    found = pd.DataFrame(
        {
            "integral over seconds": groups["over_wall"].mean().map("{:.4f}".format),
            "sd over seeds": spread.map("{:.4f}".format),
            "integral over work": groups["over_work"].mean().map("{:.4f}".format),
            "last gap": ends["gap"].mean().map("{:.2%}".format),
            "building, s": ends["build_s"].mean().map("{:.3f}".format),
            "solving, s": ends["solve_s"].mean().map("{:.3f}".format),
        }
    )
    return found.reset_index()


def _timed(
    library: Library, families: list[str], sizes: list[str], questions: int, seeds: int
) -> Iterator[dict[str, Any]]:
    for family in families:
        for size in sizes:
            rows = [r for r in library.rows.values() if (r.family, r.size) == (family, size)]
            for row in sorted(rows, key=lambda one: one.question)[:questions]:
                decision = read(library.path(row))
                for method, most in TIMED[family].items():
                    print(f"{row.question} {size} {method}", flush=True)
                    for point in points(decision, method, most, range(seeds)):
                        yield {**point, "size": size}


def _by_size(found: pd.DataFrame) -> pd.DataFrame:
    order = ["small", "medium", "real", "double"]
    frame = found.reset_index()
    frame["size"] = pd.Categorical(frame["size"], order)
    return frame.sort_values(["family", "size"]).reset_index(drop=True)


def publish_table(path: Path, rows: pd.DataFrame | list[dict[str, Any]], **more: Any) -> None:
    """Publish a table as a Markdown page with a provenance file, and print the table."""
    frame = pd.DataFrame(rows)
    _publish(path, frame.to_markdown(index=False) + "\n", **more)
    print(frame.to_string(index=False))


def _publish(path: Path, text: str, **more: Any) -> None:
    write_text(path, text)
    _record(path, **more)


def _record(path: Path, **more: Any) -> None:
    told = {
        "format": FORMAT,
        "file": path.name,
        **more,
        "written_by": {**code(), **commit()},
        "command": called(),
    }
    write_text(path.with_name(path.name + SUFFIX), json.dumps(told, indent=1, default=str) + "\n")


def _picture(path: Path, table: pd.DataFrame, kind: str) -> None:
    """Draw a performance profile or data profile (`kind`) for each family that was timed."""
    families = list(dict.fromkeys(table["family"]))
    across = min(4, len(families))
    down = math.ceil(len(families) / across)
    with saving(path, width=3.2 * across, height=2.6 * down) as figure:
        grid = figure.subplots(down, across, squeeze=False).ravel()
        for axes in grid[len(families) :]:
            axes.set_visible(False)
        for family, axes in zip(families, grid, strict=False):
            times = times_to_gap(table[table["family"] == family], SOLVED)
            shares = performance(times, RATIOS) if kind == "performance" else None
            _draw(axes, data_profile(times, SECONDS) if shares is None else shares, family)
            axes.set_xlabel("seconds" if shares is None else "times the quickest")


def _draw(axes: Axes, shares: pd.DataFrame, family: str) -> None:
    for method in shares.columns:
        axes.step(shares.index, shares[method], where="post", label=str(method))
    axes.set_xscale("log")
    axes.set_ylim(-0.02, 1.02)
    axes.set_title(family)
    axes.set_ylabel(f"share within {SOLVED:.0%}")
    axes.legend(fontsize="x-small")


if __name__ == "__main__":
    sys.exit(command(main))
