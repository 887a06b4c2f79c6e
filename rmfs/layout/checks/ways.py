"""Condition W1 of deadlock freedom: endpoints are connected by paths that avoid other endpoints.

Endpoints are the storage locations and the places in queues of stations: only there may a robot
stand for an unlimited time. Suppose that the aisles (all other waypoints) are strongly connected,
every storage location is joined to them in both directions, every queue can be entered from them,
and the head of every queue leads back to them. Then a robot that waits until all others stand at
endpoints can always proceed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.layout.checks.queues import all_queues
from rmfs.layout.checks.reach import Reach, entered_from, leading_to
from rmfs.layout.checks.violation import NOT_WELL_FORMED, grouped, waypoint_label
from rmfs.layout.graph import edge_sources

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.layout.checks.reach import Mask
    from rmfs.layout.checks.violation import Violation
    from rmfs.layout.model import Layout


def ways(layout: Layout) -> Iterator[Violation]:
    """Yield the violations of condition W1."""
    tails = edge_sources(layout)
    queues = all_queues(layout)
    standing = layout.is_storage.copy()
    for queue in queues:
        # robots in front of an elevator wait there for a limited time only
        if not queue.of_elevator:
            standing[list(queue.places)] = True
    reach = Reach(layout, ~standing)
    aisles = ~layout.is_storage & ~layout.is_queue
    core = reach.largest(aisles)
    from_core, to_core = reach.forward(core), reach.backward(core)
    entered, left = entered_from(layout, tails, from_core), leading_to(layout, tails, to_core)

    # one-way approaches and exits are fine as long as they join the core and an endpoint
    after_endpoint = reach.forward(entered_from(layout, tails, standing))
    before_endpoint = reach.backward(leading_to(layout, tails, standing))
    useful = core | (from_core & before_endpoint) | (to_core & after_endpoint)
    yield from _report(layout, aisles & ~useful, "is not strongly connected with the aisles (W1)")
    yield from _report(
        layout,
        layout.is_storage & ~entered,
        "cannot be reached from the aisles without passing another endpoint (W1)",
    )
    yield from _report(
        layout,
        layout.is_storage & ~left,
        "the aisles cannot be reached from it without passing another endpoint (W1)",
    )
    shut = [queue for queue in queues if not entered[queue.entrance]]
    for queue in shut:
        message = f"no aisle leads to the entrance of its queue, waypoint {queue.entrance} (W1)"
        yield from grouped(NOT_WELL_FORMED, [queue.label], message)
    dead = [queue.label for queue in queues if not left[queue.head]]
    yield from grouped(
        NOT_WELL_FORMED,
        dead,
        "the aisles cannot be reached from it without passing its own queue (W1)",
    )


def _report(layout: Layout, bad: Mask, message: str) -> Iterator[Violation]:
    labels = (waypoint_label(layout, int(v)) for v in np.flatnonzero(bad))
    yield from grouped(NOT_WELL_FORMED, labels, message)
