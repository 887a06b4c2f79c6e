"""The independent trace checker, which proves that all motion in a trace was safe.

The checker reads a layout and a trace, and shares neither code nor concepts with the planner: it
uses positions over time, not reservations. From the trace, it reconstructs the position of every
robot at every moment, as pieces of motion with constant acceleration. Violations are reported
as findings. If there are none, the checker has proven, without sampling, that

* the motion of each robot has no gaps or jumps, respects the robot's kinematic limits, and
  follows existing edges and elevators (`continuity`);
* no two robots on a tier overlap; a robot counts as a disc with its own radius or, if it carries a
  larger pod, with the radius of the pod (`separation`, which uses `sweep` to find pairs of pieces
  that are close, and `distance` to prove whether they come too close);
* each pod is always on one robot or at one place, no two pods share a place, and no carried pod
  overlaps a stored one (`pods`);
* no queue place and no elevator is used by two robots at the same time (`occupancy`).
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
        End of the trace in microseconds; up to then, the trace must cover every robot. A motion
        that is in progress at the end may be recorded in full or cut off there. Default: the time
        at which the last motion starts.
    slow
        All periods in which a robot is limited to a share of its top speed; at all other times,
        its limit is its full top speed. Default: the periods are unknown. Each straight run is then
        limited to the top speed that the trace states for it, which must not exceed that of the
        robot; if the trace states none, the limit is the robot's full top speed.

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
