"""A report of an experiment as one self-contained HTML file."""

from __future__ import annotations

import base64
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from rmfs.errors import InputError
from rmfs.experiments import arranging, tables
from rmfs.experiments.plotting import Wish, draw
from rmfs.experiments.statistics import anova
from rmfs.experiments.wording import heading
from rmfs.files import write_text

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import pandas as pd

    from rmfs.experiments.opening import Opened

TEMPLATE = Path(__file__).with_name("report.html.jinja")


def write_report(
    one: Opened,
    path: Path,
    columns: Sequence[str] = tables.COLUMNS,
    *,
    baseline: str | None = None,
    confidence: float = 0.95,
) -> str:
    """Write the report of an experiment.

    Parameters
    ----------
    columns
        Footprint columns to report, each with plots and, where possible, an analysis of variance.
    baseline
        Arm with which all others are compared. Default: the first.

    Returns
    -------
    A note on missing runs; empty if the experiment is complete.

    Raises
    ------
    InputError
        If there are no results, `baseline` is not an arm, or the file cannot be written.
    """
    frame, note = one.rows()
    write_text(path, _render(one, frame, note, list(columns), baseline, confidence))
    return note


def _render(
    one: Opened,
    frame: pd.DataFrame,
    note: str,
    columns: list[str],
    baseline: str | None,
    confidence: float,
) -> str:
    import jinja2

    plan = one.plan
    base = baseline if baseline is not None else str(frame["arm"].iloc[0])
    plan.arm(base)
    means = tables.means(frame, columns, confidence=confidence)
    shown = [("Means", _or_as_it_is(lambda: arranging.by_factors(means, plan), means))]
    if len(frame["arm"].unique()) > 1:
        found = tables.differences(frame, columns, base, confidence=confidence)
        shown.append((f"Differences to {base}", found))
    shown += _analyses(one, frame, columns, confidence)
    pictures = [
        (f"{title}: {heading(column)}", content)
        for column in columns
        for kind, title in (("intervals", "Every run"), ("effects", "Factors"))
        if (content := _picture(one, frame, kind, column, confidence))
    ]
    factors = [
        (short, factor, ", ".join(dict.fromkeys(str(arm.levels[factor]) for arm in plan.arms)))
        for factor, short in plan.short_names.items()
    ]
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    return environment.from_string(TEMPLATE.read_text(encoding="utf-8")).render(
        title=plan.design.name,
        description=plan.design.description,
        note=note,
        counts=f"{len(frame)} runs of {frame['arm'].nunique()} arms, "
        f"{frame['replication'].nunique()} seeds",
        factors=factors,
        tables=[(title, table.html()) for title, table in shown],
        pictures=pictures,
        made=[
            ("design", plan.hash),
            ("rmfs", ", ".join(sorted(set(frame["rmfs_version"])))),
            ("code", ", ".join(sorted(set(frame["code"])))),
        ],
    )


def _analyses(
    one: Opened, frame: pd.DataFrame, columns: list[str], confidence: float
) -> list[tuple[str, tables.Table]]:
    """Return an analysis of variance for each column with enough factors and runs."""
    made = []
    for column in columns:
        try:
            found = anova(
                frame,
                column,
                one.plan.factors,
                confidence=confidence,
                names=one.plan.short_names,
            )
        except InputError:
            continue
        made.append((f"Analysis of variance: {heading(column)}", tables.effects(found, column)))
    return made


def _or_as_it_is(make: Callable[[], tables.Table], table: tables.Table) -> tables.Table:
    try:
        return make()
    except InputError:
        return table


def _picture(
    one: Opened, frame: pd.DataFrame, kind: str, column: str, confidence: float
) -> str | None:
    """Return a plot as base64 text for a data URL; None if it cannot be drawn."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.png"
        try:
            draw(kind, one.plan, frame, one.store.folder, [column], path, Wish(confidence))
        except InputError:
            return None
        return base64.b64encode(path.read_bytes()).decode("ascii")
