"""Charge assignment (CA): which robot gets energy, where, from when, and until which level."""

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
    """Sends robots without pod to stations where they get energy, and away again.

    It is asked before TA, about the robots of `view.asking` and `view.resting`; only in runs whose
    robots have batteries (`view.batteries`). A robot that could not finish another task and reach a
    station for energy after it is sent there in any case, whatever the rule says.
    """

    problem = Problem.CA
    triggers = frozenset({Trigger.START, Trigger.ROBOT_FREE})

    @abstractmethod
    def decide(self) -> Iterator[Charge | Unplug | Ask[Any] | By[Any]]:
        """Yield who is to go for energy, and who is to leave a plug-in place."""

    def target_share(self) -> float:
        """Level until which robots stay that were sent in any case."""
        return 0.8
