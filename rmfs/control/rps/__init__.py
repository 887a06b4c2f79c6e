"""Replenishment pod selection (RPS): which pod a bundle goes into, and when that is made known."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, TypeVar

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem, Trigger

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.asks import Ask, By
    from rmfs.control.decisions import PromiseBundle, ReleasePod, SendBundle

P = TypeVar("P", bound=Parameters)


class ReplenishmentPodSelection(Controller[P]):
    """Chooses pods for the bundles of `view.bundles.without_pod`.

    The pod keeps the bundle's space free at once. ROA and TA may act on the choice only when it is
    released; until then further bundles can be promised to the same pod, so that it makes one trip
    for all of them (`view.bundles.unreleased`).
    """

    problem = Problem.RPS
    triggers = frozenset({Trigger.START, Trigger.NEW_BUNDLE, Trigger.UNIT_PICKED})

    @abstractmethod
    def decide(self) -> Iterator[PromiseBundle | ReleasePod | SendBundle | Ask[Any] | By[Any]]:
        """Yield promises and releases until nothing is to be decided now.

        A rule that also decides ROA sends the bundles of a pod after it has released them.
        """
