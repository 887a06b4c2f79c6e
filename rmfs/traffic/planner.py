"""Path planners in Python: their interface, the state they see, and the questions they may ask.

A planner in Python is a rolling planner: in each call, it returns a desired path for every driving
robot, and the core grants as much of each path as is free. A planner therefore cannot cause a
collision.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from rmfs.traffic._core import Along, Conflict, Reserved, Search, Way

if TYPE_CHECKING:
    from collections.abc import Generator

__all__ = [
    "Agent",
    "Along",
    "Conflict",
    "PathPlanner",
    "Question",
    "Reserved",
    "Search",
    "Way",
]

Question = Search | Along | Conflict | Reserved
"""Questions that a planner may yield, and the answers it gets.

`Search(agent, around=(), until_us=None, labels=2000)`
    The best path of an agent (its index in `agents`) that avoids all granted motion and the paths
    in `around`; None if none is found. It leads to the goal or, if `until_us` is given, as far
    towards it as is best until that time. At most `labels` labels are expanded.
`Along(agent, stops, ready_us=None)`
    The path over the given stops (waypoints) by straight runs and elevator rides, starting as early
    as possible but not before `ready_us`, ignoring other robots.
`Conflict(ways, until_us=0)`
    The first conflict between two of the paths: their numbers in the list, the waypoint, and the
    time interval in which both need it; None if there is none. Robots stay at the ends of their
    paths until `until_us`.
`Reserved(waypoint)`
    The reservations granted there: a list of (start, end, robot), in microseconds.
"""


class Agent(NamedTuple):
    """A robot that is driving to a goal.

    Attributes
    ----------
    robot
        Index of the robot.
    waypoint
        Waypoint at which the rest of the robot's path begins: where the robot stands, or where its
        granted motion ends.
    heading_rad
        Heading of the robot at this waypoint.
    ready_us
        Earliest time in us at which the robot can continue from this waypoint.
    goal
        Destination waypoint.
    loaded
        Whether the robot carries a pod.
    needs_plan
        Whether the robot has no path, or its path was refused.
    to_go_us
        Unhindered time to the goal in us; None if there is no path.
    """

    robot: int
    waypoint: int
    heading_rad: float
    ready_us: int
    goal: int
    loaded: bool
    needs_plan: bool
    to_go_us: int | None


class PathPlanner(Protocol):
    """A planner written in Python."""

    def plan(self, now_us: int, agents: list[Agent]) -> Generator[Question, Any, list[Way | None]]:
        """Plan paths for all driving robots.

        Parameters
        ----------
        now_us
            Current time in microseconds.
        agents
            The driving robots, by ascending index.

        Yields
        ------
        Question
            A question; its answer is the value of the `yield` expression.

        Returns
        -------
        list
            A path or None for each agent. With None, the agent keeps its earlier path (without
            one, it stays where it is), and the planner is called again. If a path does not reach
            the goal, the core appends the rest without checking it for conflicts.
        """
        ...


class Conversation:
    """Adapter between a planner and the core; converts plain tuples of the core to `Agent`."""

    def __init__(self, planner: PathPlanner) -> None:
        self._planner = planner

    def begin(
        self, now_us: int, agents: list[tuple[Any, ...]]
    ) -> Generator[Question, Any, list[Way | None]]:
        """Start a call of the planner; questions and answers are passed on unchanged."""
        return self._planner.plan(now_us, [Agent(*agent) for agent in agents])
