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

    If several controllers are to decide at the same instant, MM decides first. Commitments that a
    controller has made (bundles promised to pods, tasks of robots) are not stored in the
    controller, so they remain in force when it is replaced.
    """

    problem = Problem.MM
    triggers = frozenset({Trigger.START})

    @abstractmethod
    def decide(self) -> Iterator[Exchange]:
        """Yield the exchanges to be made now."""

    @classmethod
    def check(cls, choices: Mapping[Problem, Choice], source: str) -> None:
        """Check, when a controllers file is read, that all exchanges lead to compatible rules.

        The base class checks nothing.

        Parameters
        ----------
        choices
            The initial controllers, including MM.

        Raises
        ------
        InputError
            If the rules cannot be combined; the message names them.
        """
