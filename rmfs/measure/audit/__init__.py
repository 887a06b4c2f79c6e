"""The audit of a run: whether all that its files say is possible and fits together.

It reads the folder alone, and knows nothing of how a run is made: motion is proven safe by the
trace checker, and the events are kept account of like the books of a firm. `rmfs check RUN` shows
what it finds.
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
        If the run was made without a trace, a file is damaged, or names what is not there: what
        cannot be looked at at all.
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
