"""The part of the robots' state on which tasks depend; `rmfs.traffic` simulates the motion."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.world.tasks import Task


@dataclass(slots=True, eq=False)
class Robot:
    """One robot.

    Attributes
    ----------
    tier
        Tier of `waypoint`.
    waypoint
        Waypoint at which its current drive ends or, if it is not driving, at which it stands. This
        is the waypoint of a station, a storage location, or the robot's initial waypoint.
    pod
        The pod it carries, from the start of lifting to the end of setting down; or -1.
    task
        Its current task; None if it needs one.
    station
        The station where it stands at the head of the queue; -1 if there is none.
    places
        Storage locations that are reserved for it because it stands or will stand there.
    prepared
        Tasks that are to follow its current one. Nothing is reserved for them: a task that is no
        longer possible when it is due is dropped.
    """

    index: int
    tier: int
    waypoint: int
    pod: int = -1
    task: Task | None = None
    station: int = -1
    places: list[int] = field(default_factory=list)
    prepared: deque[Task] = field(default_factory=deque)

    @property
    def is_free(self) -> bool:
        """Whether the robot carries nothing and has no task other than resting."""
        task = self.task
        return self.pod < 0 and (task is None or task.rests)
