"""Replenishment pod selection (RPS): which pod gets a bundle, and when the bundle is released."""

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

    When a bundle is promised to a pod, space for the bundle is reserved on the pod immediately. ROA
    and TA may act on the promise only after the bundle has been released. Until then, the bundle is
    listed in `view.bundles.unreleased`, and further bundles can be promised to the pod, so that one
    trip serves all of them.
    """

    problem = Problem.RPS
    triggers = frozenset({Trigger.START, Trigger.NEW_BUNDLE, Trigger.UNIT_PICKED})

    @abstractmethod
    def decide(self) -> Iterator[PromiseBundle | ReleasePod | SendBundle | Ask[Any] | By[Any]]:
        """Yield promises and releases until there is nothing more to decide now.

        If the controller also decides ROA, it first releases the bundles of a pod, and then yields
        the stations to which the bundles are sent.
        """
