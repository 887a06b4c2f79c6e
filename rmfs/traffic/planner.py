"""Planners in Python: what one is, what it is told, and what it may ask.

A planner in Python is a rolling planner: asked for all robots that drive, it returns a way for each
as a wish, and the core grants of it what is free. So no planner can cause a collision.
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
"""What a planner may yield, and what it is sent for it.

`Search(agent, around=(), until_us=None, labels=2000)`
    The best way of an agent (by its number in the call) around what is granted and around ways of
    others, or None: to its goal, or within a window that ends at `until_us`. At most so many labels
    are looked at.
`Along(agent, stops, ready_us=None)`
    The way over stops (waypoints) by straight runs and elevator rides, begun as early as possible
    but not before `ready_us`, whoever is there.
`Conflict(ways, until_us=0)`
    Where two of the ways meet first: their numbers in the list, the waypoint, and from when to when
    both want it; None if they do not. Robots stay at their ends until `until_us`.
`Reserved(waypoint)`
    What is granted there: a list of (start, end, robot), in microseconds.
"""


class Agent(NamedTuple):
    """A robot that wants to drive.

    Attributes
    ----------
    robot
        Its number.
    waypoint
        Where the rest of its way can be chosen: where it stands, or where what it has been granted
        ends.
    heading_rad
        Its heading there.
    ready_us
        When it is there.
    goal
        The waypoint it wants to reach.
    loaded
        Whether it carries a pod.
    needs_plan
        Whether it has no way, or was refused the one it had.
    to_go_us
        Unhindered time to the goal; None if there is no way.
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
        """Plan ways for all robots that drive.

        Parameters
        ----------
        now_us
            The time, in microseconds.
        agents
            The robots, always in the same order.

        Yields
        ------
        Question
            One at a time; what comes back is the answer.

        Returns
        -------
        list
            A way for each agent, or None if it is to stay and to be planned again. What is left to
            the goal behind the end of a way is added, unchecked.
        """
        ...


class Conversation:
    """A planner as the core talks to it: with plain tuples."""

    def __init__(self, planner: PathPlanner) -> None:
        self._planner = planner

    def begin(
        self, now_us: int, agents: list[tuple[Any, ...]]
    ) -> Generator[Question, Any, list[Way | None]]:
        """Start a call."""
        return self._planner.plan(now_us, [Agent(*agent) for agent in agents])
