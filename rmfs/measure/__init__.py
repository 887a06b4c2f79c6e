"""Results of a run: footprint, tables, heat maps and traces, and an independent check of traces.

`Recorder` observes a run. From its logs, `tables` makes the tables that `dictionary` describes, and
`measures` computes the footprint; `folder` writes and reads run folders; `checker` checks whether
the motion in a trace is safe.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.measure.base import Measure as Measure
from rmfs.measure.columns import Column as Column
from rmfs.measure.ended import EndedRun as EndedRun
from rmfs.measure.events import EventLog as EventLog
from rmfs.measure.folder import RunFolder as RunFolder
from rmfs.measure.folder import load_run as load_run
from rmfs.measure.folder import write_run as write_run
from rmfs.measure.recorder import Recorder as Recorder
from rmfs.observer import Observer as Observer

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.checker import CheckReport
    from rmfs.measure.ended import Measured

# pandas is imported only when a table is needed


def footprint(run: Measured, report: CheckReport | None = None) -> pd.Series:
    """Return the footprint of a finished run: one value per column of the table `footprint`.

    Parameters
    ----------
    report
        Result of the trace checker; without it, the column `collisions` is empty.
    """
    from rmfs.measure.footprints import some_tables

    return some_tables(run, (), report)["footprint"].iloc[0]


def series(run: Measured) -> pd.DataFrame:
    """Return the table `series` of a run, one row per minute of the measured time."""
    from rmfs.measure import tables

    return tables.series(tables.Logs(run.recorder))


def decisions(run: Measured) -> pd.DataFrame:
    """Return the table `decisions` of a run.

    It covers the measured time. There is one row for each call in which a controller made decisions
    by itself, that is, without an optimiser, and one row for each question to an optimiser.
    """
    from rmfs.measure import tables

    return tables.decisions(tables.Logs(run.recorder))
