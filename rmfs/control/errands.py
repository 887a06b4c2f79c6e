"""Asks PPS, PSA or repositioning to complete TA decisions made outside the simulation."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.decisions import Park, Reposition
from rmfs.control.ta.stations import bring, keeper_of

if TYPE_CHECKING:
    from rmfs.control.decisions import MovePod, Store, TaskDecision, WorkFor
    from rmfs.control.ta import Consult
    from rmfs.control.view import View


def work(decision: WorkFor, view: View, consult: Consult) -> TaskDecision | None:
    """Return the task for a `WorkFor` decision; None if PPS must choose a pod and finds none."""
    robot, station = decision
    if robot.pod >= 0:
        return bring(view, robot, robot.pod, station)
    pod = consult.pod_for(robot, station)
    return bring(view, keeper_of(view, robot, pod), pod, station) if pod >= 0 else None


def store(decision: Store, consult: Consult) -> TaskDecision | None:
    """Return the task for a `Store` decision; None if PSA finds no storage location."""
    place = consult.place_for(decision.robot)
    return Park(decision.robot, place) if place >= 0 else None


def move_pod(decision: MovePod, view: View, consult: Consult) -> TaskDecision | None:
    """Return the task for a `MovePod` decision; None if the repositioning rule finds no move."""
    move = consult.move_for(decision.robot)
    if move is None:
        return None
    return Reposition(keeper_of(view, decision.robot, move.pod), move.pod, move.place)
