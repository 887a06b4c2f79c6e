"""Replenishment order assignment (ROA): which bundle goes to which replenishment station."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, TypeVar

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem, Trigger

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.asks import Ask, By
    from rmfs.control.decisions import SendBundle

P = TypeVar("P", bound=Parameters)


class ReplenishmentOrderAssignment(Controller[P]):
    """Chooses stations for the bundles of `view.bundles.without_station`.

    Space for a bundle is reserved at its station immediately. `view.bundles.released` contains, for
    each pod, the bundles that RPS has released for the pod and that have no station yet. Once a
    bundle has been released and has a station, TA can let a robot bring the pod to that station.
    """

    problem = Problem.ROA
    triggers = frozenset(
        {Trigger.START, Trigger.NEW_BUNDLE, Trigger.BUNDLE_STORED, Trigger.STATION_SWITCHED}
    )

    @abstractmethod
    def decide(self) -> Iterator[SendBundle | Ask[Any] | By[Any]]:
        """Yield decisions until no further bundle should be sent now."""
