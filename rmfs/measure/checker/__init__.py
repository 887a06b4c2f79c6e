"""The independent trace checker, which proves that all motion in a trace was safe.

It reads a layout and a trace and shares neither code nor concepts with the planner: it knows
positions over time, not reservations. From the trace it reconstructs the position of every robot at
every moment, as pieces of constant acceleration, and proves on these (without sampling) that

* each trace is gapless and continuous, within the robot's kinematics, along edges and elevators
  that exist (`continuity`);
* no two robot discs overlap on a tier; a robot that carries a larger pod is as large as the pod
  (`sweep` finds nearby pairs, `distance` bounds their distance from below, `separation`);
* pods are conserved, never share a place, and no carried pod touches a stored one (`pods`);
* a queue place and an elevator each hold at most one robot (`occupancy`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import continuity, motion, occupancy, pods, separation
from .report import CheckReport as CheckReport
from .report import Finding as Finding
from .report import FindingKind as FindingKind
from .trace import Kinematics, read
from .trace import Motion as Motion
from .trace import Slow as Slow

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rmfs.layout.model import Layout


def check(
    layout: Layout,
    trace: Mapping[str, Any],
    until_us: int | None = None,
    *,
    slow: Sequence[Slow] | None = None,
) -> CheckReport:
    """Check a whole trace.

    Parameters
    ----------
    layout
        Initial positions of robots and pods, and the rules for motion.
    trace
        The trace's columns by name: arrays of equal length or a pandas frame.
    until_us
        End of the trace in microseconds; up to then, the trace must cover every robot. A motion in
        progress then may be recorded in full or be cut off. Default: the start of the last motion.
    slow
        Periods in which robots are limited to a share of their top speed; outside these periods,
        they are not. Default: periods are not checked, and each straight run is limited to the
        top speed stated for it in the trace, which must not exceed that of the robot.

    Raises
    ------
    InputError
        If the columns are not a valid trace of this layout.
    """
    rows = read(layout, trace)
    end_us = rows.end_us if until_us is None else until_us
    robots = Kinematics.of(layout, rows.robot)
    limits = robots.told(rows) if slow is None else robots.slowed(rows, slow)
    pieces = motion.cut(layout, rows, limits)
    collisions, pairs = separation.check(layout, rows, limits, pieces)
    findings = [
        *continuity.check(layout, rows, limits, end_us),
        *continuity.speeds(rows, limits),
        *collisions,
        *pods.check(layout, rows, pieces),
        *occupancy.check(layout, rows),
    ]
    findings.sort(key=lambda finding: (finding.time_s, finding.kind, finding.robots))
    return CheckReport(findings, len(rows), pairs)
