"""The independent trace checker: proof that what was driven was safe.

It reads a layout and a trace, and shares no code and no notion with the planner: it knows positions
over time, not reservations. From the trace it rebuilds where every robot is at every moment, as
pieces of constant acceleration, and proves on these (not by sampling) that

* each trace is gapless and continuous, within the robot's kinematics, along edges and elevators
  that exist (`continuity`);
* no two robot discs overlap on a tier; a robot that carries a pod is as large as the pod
  (`sweep` finds who is near whom, `distance` bounds their distance from below, `separation`);
* pods are conserved, stand one to a place, and no carried pod touches a stored one (`pods`);
* a queue place and an elevator hold one robot each (`occupancy`).
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
    slow: Sequence[Slow] = (),
) -> CheckReport:
    """Check a whole trace.

    Parameters
    ----------
    layout
        Where robots and pods are when the trace begins, and what they may do.
    trace
        The trace's columns by name: arrays of equal length or a pandas frame.
    until_us
        When the trace ends, in microseconds: every robot must be told of until then. Motions that
        reach it may end later or be cut short. Default: when the last row of all begins.
    slow
        Times at which robots drive slower than they should; they must do so then.

    Raises
    ------
    InputError
        If the columns cannot be interpreted as a trace of this layout.
    """
    rows = read(layout, trace)
    end_us = int(rows.t0_us.max(initial=0)) if until_us is None else until_us
    limits = Kinematics.of(layout, rows.robot).slowed(rows, slow)
    pieces = motion.cut(layout, rows, limits)
    collisions, pairs = separation.check(layout, rows, limits, pieces)
    findings = [
        *continuity.check(layout, rows, limits, end_us),
        *collisions,
        *pods.check(layout, rows, pieces),
        *occupancy.check(layout, rows),
    ]
    findings.sort(key=lambda finding: (finding.time_s, finding.kind, finding.robots))
    return CheckReport(findings, len(rows), pairs)
