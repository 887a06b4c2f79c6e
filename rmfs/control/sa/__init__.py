"""Station activation (SA): which stations take new work."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, TypeVar

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem, Trigger

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.decisions import SwitchStation

P = TypeVar("P", bound=Parameters)


class StationActivation(Controller[P]):
    """Switches stations on and off; all are off before the first decision.

    A station that is off finishes its assigned work and gets no new work.
    """

    problem = Problem.SA
    triggers = frozenset({Trigger.START})

    @abstractmethod
    def decide(self) -> Iterator[SwitchStation]:
        """Yield a decision for each station that is to be switched on or off now."""
