"""Method management (MM): exchange of controllers while the system runs."""

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
    """Says which controller is to be exchanged for which, and when; it is asked before all others.

    The world remembers what controllers have promised (bundles on pods, robots on tasks), so that a
    successor carries on where its predecessor stopped.
    """

    problem = Problem.MM
    triggers = frozenset({Trigger.START})

    @abstractmethod
    def decide(self) -> Iterator[Exchange]:
        """Yield the controllers to be installed now."""

    @classmethod
    def check(cls, choices: Mapping[Problem, Choice], source: str) -> None:
        """Refuse, when a file is read, exchanges after which rules would not go together.

        Parameters
        ----------
        choices
            The controllers of the beginning, MM itself included.

        Raises
        ------
        InputError
            Naming the rules.
        """
