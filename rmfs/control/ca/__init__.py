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
    """Sends robots without a pod to energy stations, and can make them leave chargers early.

    Energy stations are chargers and swap stations. CA decides before TA, and only in runs whose
    robots have batteries (`view.batteries`). It can send the robots of `view.asking` and
    `view.resting`. Independently of the rule, the simulation sends a robot to an energy station if
    the robot's charge may not suffice for another task followed by a trip to the station.
    """

    problem = Problem.CA
    triggers = frozenset({Trigger.START, Trigger.ROBOT_FREE})

    @abstractmethod
    def decide(self) -> Iterator[Charge | Unplug | Ask[Any] | By[Any]]:
        """Yield decisions that send robots to energy stations or make them leave chargers."""

    def target_share(self) -> float:
        """Return the level (share of capacity) to which robots charge if the simulation sends them.

        Independently of the rule, the simulation sends a robot to charge if its charge is low.
        """
        return 0.8
