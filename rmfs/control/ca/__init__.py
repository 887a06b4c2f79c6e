"""Charge assignment (CA): which robot charges where, from when, and up to which level."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, TypeVar

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem, Trigger

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.asks import Ask, By
    from rmfs.control.decisions import Charge, Unplug

P = TypeVar("P", bound=Parameters)


class ChargeAssignment(Controller[P]):
    """Sends robots without a pod to stations where they get energy, and away again.

    It is asked before TA, about the robots of `view.asking` and `view.resting`, and only in runs
    whose robots have batteries (`view.batteries`). A robot that could not complete another task and
    then reach an energy station is sent there in any case, whatever the rule decides.
    """

    problem = Problem.CA
    triggers = frozenset({Trigger.START, Trigger.ROBOT_FREE})

    @abstractmethod
    def decide(self) -> Iterator[Charge | Unplug | Ask[Any] | By[Any]]:
        """Yield decisions: robots to be sent to charge, and robots to leave a plug-in place."""

    def target_share(self) -> float:
        """Level (share of capacity) up to which a robot charges if it is sent in any case."""
        return 0.8
