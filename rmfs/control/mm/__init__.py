"""Method management (MM): exchange of controllers during a run."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, TypeVar

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem, Trigger

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rmfs.control.choices import Choice
    from rmfs.control.decisions import Exchange

P = TypeVar("P", bound=Parameters)


class MethodManagement(Controller[P]):
    """Decides which controllers are replaced by which others, and when.

    It is asked before all other controllers. Commitments of a controller (bundles promised to pods,
    robots with tasks) are part of the world, so that a successor continues where its predecessor
    stopped.
    """

    problem = Problem.MM
    triggers = frozenset({Trigger.START})

    @abstractmethod
    def decide(self) -> Iterator[Exchange]:
        """Yield the controllers to be installed now."""

    @classmethod
    def check(cls, choices: Mapping[Problem, Choice], source: str) -> None:
        """Check, when a file is read, that rules can be combined after exchanges.

        By default nothing is checked.

        Parameters
        ----------
        choices
            The initial controllers, including MM.

        Raises
        ------
        InputError
            If the rules cannot be combined; the message names them.
        """
