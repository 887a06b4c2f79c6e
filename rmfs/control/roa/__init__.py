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

    The station reserves the bundle's space at once. `view.bundles.released` contains the bundles
    whose pod has been decided. A bundle can be handled when both its pod and its station have been
    decided.
    """

    problem = Problem.ROA
    triggers = frozenset(
        {Trigger.START, Trigger.NEW_BUNDLE, Trigger.BUNDLE_STORED, Trigger.STATION_SWITCHED}
    )

    @abstractmethod
    def decide(self) -> Iterator[SendBundle | Ask[Any] | By[Any]]:
        """Yield pairs of bundle and station until no more bundles should be sent now."""
