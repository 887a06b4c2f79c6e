"""The audit of a run: whether the contents of its files are possible and consistent.

The audit reads only the run folder and is independent of the simulation. The trace checker verifies
the motion, and events are compared with each other, with the motion and with the tables. The
command `rmfs check RUN` prints the findings.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.measure.audit import bundles, orders, slots, stock, totals, visits
from rmfs.measure.audit.report import Audit as Audit
from rmfs.measure.audit.report import Chapter as Chapter
from rmfs.measure.audit.rows import Rows

if TYPE_CHECKING:
    from rmfs.layout.model import Layout
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
        orders.check(rows, _finished_us(run, layout, end_us)),
        slots.check(layout, rows),
        bundles.check(layout, rows, skus),
        bundles.check_bound(rows),
        totals.check(rows, run.footprint, run.table("orders"), run.table("stations")),
    ]
    return Audit(run.check(), chapters)


def _finished_us(run: RunFolder, layout: Layout, end_us: int) -> int:
    """Return a time (us) such that all picks begun before it were finished at the end of the run.

    The result is -1 (unknown) if pickers have times of their own, if orders may wait for packing,
    or if there are no pick stations.
    """
    varies = run.footprint[["picker_busy_share", "station_blocked_share"]].notna()
    if varies.any() or not layout.pick_stations:
        return -1
    longest_s = max(station.unit_transfer_s for station in layout.pick_stations)
    return end_us - round(longest_s * 1e6)
