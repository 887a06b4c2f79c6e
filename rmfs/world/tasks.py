"""What a robot has been told to do."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rmfs.world.orders import Bundle, OrderLine


class TaskKind(StrEnum):
    """Kinds of task."""

    PICK = "pick"
    REPLENISH = "replenish"
    PARK = "park"
    REPOSITION = "reposition"
    REST = "rest"


class Pick(NamedTuple):
    """One unit to be picked: the line it is for, and whether it was bound on the pod's way."""

    line: OrderLine
    late_bound: bool


@dataclass(slots=True, eq=False)
class Task:
    """One task of one robot.

    Attributes
    ----------
    pod
        The pod to bring, to park or to reposition; -1 for rest.
    station
        Where the pod is to be served, or -1.
    place
        Where the pod is to be stored, or the robot is to rest; a waypoint, or -1.
    picks
        Units still to be picked.
    bundles
        Bundles still to be stored.
    """

    kind: TaskKind
    robot: int
    pod: int = -1
    station: int = -1
    place: int = -1
    picks: deque[Pick] = field(default_factory=deque)
    bundles: deque[Bundle] = field(default_factory=deque)

    @property
    def can_pick(self) -> bool:
        """Whether the order of one of its picks is on the station (others are still queued)."""
        return any(pick.line.order.station >= 0 for pick in self.picks)
