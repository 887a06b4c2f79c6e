"""The end of a task."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.simulation.events import Events
    from rmfs.world import World


def end_task(world: World, events: Events, robot: int) -> None:
    """End a robot's task; the robot then needs a new one."""
    world.end_task(world.robots[robot])
    events.robot_free(robot)
