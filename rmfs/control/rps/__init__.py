"""Replenishment pod selection (RPS): the pod of each bundle, and when the choice is released."""

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

    Space for the bundle is reserved on the pod immediately. ROA and TA may act on the choice
    only after it is released; until then further bundles can be promised to the same pod, so that
    one trip serves all of them (`view.bundles.unreleased`).
    """

    problem = Problem.RPS
    triggers = frozenset({Trigger.START, Trigger.NEW_BUNDLE, Trigger.UNIT_PICKED})

    @abstractmethod
    def decide(self) -> Iterator[PromiseBundle | ReleasePod | SendBundle | Ask[Any] | By[Any]]:
        """Yield promises and releases until there is nothing more to decide now.

        A rule that also decides ROA sends the bundles of a pod after it has released them.
        """
