"""Repositioning: which idle pod is moved where, so that it is better placed for later work."""

from __future__ import annotations

from abc import abstractmethod
from math import inf
from typing import TYPE_CHECKING, Annotated, ClassVar, NamedTuple, TypeVar

import pydantic

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from rmfs.control.travel import Metric
    from rmfs.control.view import View
    from rmfs.world.robots import Robot

Seconds = Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)]


class Move(NamedTuple):
    """A move of an available pod to an empty storage location (`place`, a waypoint)."""

    pod: int
    place: int


def nearest_place(view: View, pod: int, among: NDArray[np.bool_], metric: Metric) -> int:
    """Find the storage location nearest to a stored pod; ties go to the lowest waypoint number.

    Parameters
    ----------
    among
        Whether each of the L storage locations may be chosen, shape (L,).
    metric
        Measure of distance (`rmfs.control.travel.Metric`).

    Returns
    -------
    int
        The waypoint of the location; -1 if none may be chosen.
    """
    places = view.storage.places[among]
    if not len(places):
        return -1
    return int(places[view.travel.between(view.storage.place_of[pod], places, metric).argmin()])


class Pauses(Parameters):
    """Common parameters of the repositioning rules that move pods."""

    robot_pause_s: Seconds = 15.0
    """Time, in seconds, after a robot is given a move before it may be given another."""
    search_pause_s: Seconds = 15.0
    """Time, in seconds, after an unsuccessful search for a move before the next search."""


P = TypeVar("P", bound=Parameters)


class Repositioning(Controller[P]):
    """Chooses an available pod, and the empty storage location to which it is moved.

    TA asks for a move on behalf of a robot without a pod, usually one that would otherwise rest. If
    another idle robot stands beneath the chosen pod, that robot makes the move instead. The pod and
    the location are reserved immediately for the robot that makes the move.
    """

    problem = Problem.REPOSITIONING
    never: ClassVar[bool] = False
    """Whether the rule never moves pods, so that TA need not ask for moves."""

    @abstractmethod
    def move(self, robot: Robot) -> Move | None:
        """Choose a pod and its new storage location; None if no move is worthwhile."""

    def is_ready(self, robot: Robot) -> bool:
        """Return whether `move` should be called for this robot now.

        Implementations must be very fast.
        """
        return True


Q = TypeVar("Q", bound=Pauses)


class Pausing(Repositioning[Q]):
    """Base class of rules that pause after moves and after unsuccessful searches.

    During a pause, the rule does not search for moves. The pause after a move applies only to the
    robot on whose behalf TA asked; the pause after an unsuccessful search applies to all robots.
    A pause that followed an unsuccessful search, or that has prevented a search, triggers TA when
    it ends.
    """

    def __init__(self, parameters: Q, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._robot_from_s = [-inf] * len(view.robots)
        self._search_from_s = -inf
        self._again_s = inf

    @abstractmethod
    def find(self, robot: Robot) -> Move | None:
        """Find the best move; None if there is none."""

    def move(self, robot: Robot) -> Move | None:
        """Return the best move, or None if there is none, and begin the pause that follows."""
        now_s = self.view.now_s
        found = self.find(robot)
        if found is not None:
            self._robot_from_s[robot.index] = now_s + self.parameters.robot_pause_s
        else:
            self._search_from_s = now_s + self.parameters.search_pause_s
            self._again_s = min(self._again_s, self._search_from_s)
        return found

    def is_ready(self, robot: Robot) -> bool:
        """Return whether no pause applies to the robot now."""
        ready_s = max(self._search_from_s, self._robot_from_s[robot.index])
        if self.view.now_s >= ready_s:
            return True
        self._again_s = min(self._again_s, ready_s)
        return False

    def next_event_s(self) -> float:
        """Return the simulated time, in s, at which the end of a pause triggers TA; inf if none."""
        if self._again_s <= self.view.now_s:
            self._again_s = inf
        return self._again_s
