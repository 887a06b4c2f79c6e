"""Questions that a program outside the simulation can answer in place of a controller."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.control.problems import Problem


@dataclass(frozen=True)
class Question:
    """A question to a program outside the simulation.

    Attributes
    ----------
    kind
        `turn` asks for the next decision of a problem. The other kinds are questions that TA asks:
        `pick pod`, `replenishment pod` and `next station` (decided by PPS), `place` (by PSA) and
        `move` (by repositioning).
    robot
        The robot for which TA asks; -1 for a turn.
    stations
        For `pick pod` and `replenishment pod`, the station; for `next station`, the stations
        to choose from.
    """

    problem: Problem
    kind: str
    robot: int = -1
    stations: tuple[int, ...] = ()
