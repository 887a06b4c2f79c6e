"""The check of a layout before a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.errors import LayoutError
from rmfs.layout.checks.connection import connection
from rmfs.layout.checks.occupancy import occupancy
from rmfs.layout.checks.population import population
from rmfs.layout.checks.queues import queue_lists
from rmfs.layout.checks.separation import separation
from rmfs.layout.checks.violation import IMPOSSIBLE as IMPOSSIBLE
from rmfs.layout.checks.violation import NOT_WELL_FORMED as NOT_WELL_FORMED
from rmfs.layout.checks.violation import Violation as Violation
from rmfs.layout.checks.ways import ways

if TYPE_CHECKING:
    from rmfs.layout.model import Layout

CHECKS = (population, occupancy, connection, separation, queue_lists, ways)


def check(layout: Layout) -> list[Violation]:
    """Return all faults of a layout, those with severity "impossible" first.

    A layout without faults has the following properties:

    - There are robots, pick stations and replenishment stations.
    - All elements are in permitted places.
    - Robots, with and without a pod, can reach and leave every storage location, station and
      elevator.
    - Robots and pods cannot overlap.
    - The conditions W1-W3 of deadlock freedom (docs/safety.md) hold as far as they concern the
      layout. Among other things, the aisles are strongly connected, every robot has a place to
      rest, and the places of each queue form a chain.
    """
    found = [violation for checks in CHECKS for violation in checks(layout)]
    return sorted(found, key=lambda violation: violation.severity != IMPOSSIBLE)


def refuse(layout: Layout, source: str, *, allow_not_well_formed: bool = False) -> None:
    """Raise an error if a layout must not be simulated.

    Parameters
    ----------
    source
        File or name of the layout, for the message.
    allow_not_well_formed
        Whether to accept a layout if all its faults have the severity "not well-formed".

    Raises
    ------
    LayoutError
        If there are violations that are not allowed; the message lists all of them.
    """
    problems = [
        str(violation)
        for violation in check(layout)
        if violation.severity == IMPOSSIBLE or not allow_not_well_formed
    ]
    if problems:
        raise LayoutError(source, problems)
