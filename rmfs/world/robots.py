"""State of the robots, as far as tasks are concerned; traffic knows how they move."""

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
        Where it is, or will be when its present drive ends.
    waypoint
        Where its present drive ends, or where it stands: a station's waypoint, a place, or its
        start.
    pod
        The pod it carries, from the start of lifting to the end of setting down; or -1.
    task
        What it does; None if it waits to be told.
    station
        The station at whose head it stands, or -1.
    places
        Storage places it stands at, or is going to stand at: nobody else may be sent there.
    prepared
        Tasks it is to have after its present one, as far as they are possible then; nothing is kept
        for them.
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
        """Whether it carries nothing and has nothing to do but rest."""
        task = self.task
        return self.pod < 0 and (task is None or task.rests)
