"""The audit of a run: whether the contents of its files are possible and consistent.

It reads only the run folder and is independent of the simulation: motion is verified by the trace
checker, and the events are checked against each other. `rmfs check RUN` prints the findings.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.measure.audit import bundles, orders, slots, stock, totals, visits
from rmfs.measure.audit.report import Audit as Audit
from rmfs.measure.audit.report import Chapter as Chapter
from rmfs.measure.audit.rows import Rows

if TYPE_CHECKING:
    from rmfs.measure.folder import RunFolder


def audit(run: RunFolder) -> Audit:
    """Audit a run from its folder.

    Raises
    ------
    InputError
        If the run cannot be audited: it was made without a trace, or a file is damaged or refers to
        things that do not exist.
    """
    layout, motion, events = run.replayed()
    rows, skus, end_us = Rows.of(events), run.table("skus"), run.told.end_us
    chapters = [
        stock.check(layout, rows, skus, run.table("pods")),
        visits.check(layout, rows, motion, end_us),
        orders.check(rows),
        slots.check(layout, rows),
        bundles.check(layout, rows, skus),
        bundles.check_bound(rows),
        totals.check(rows, run.footprint, run.table("orders"), run.table("stations")),
    ]
    return Audit(run.check(), chapters)
