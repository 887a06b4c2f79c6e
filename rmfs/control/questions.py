"""Questions that a program outside the simulation can answer in place of a controller."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rmfs.control.problems import Problem


class Question(NamedTuple):
    """A question to a program outside the simulation.

    Attributes
    ----------
    kind
        `turn` asks for the next decision on a problem. All other kinds are questions of TA to
        another problem: to PPS (`pick pod`, `replenishment pod` or `next station`), to PSA
        (`place`), or to repositioning (`move`).
    robot
        The robot for which TA asks; -1 if the kind is `turn`.
    stations
        For `pick pod` and `replenishment pod`, the station; for `next station`, the stations
        to choose from.
    """

    problem: Problem
    kind: str
    robot: int = -1
    stations: tuple[int, ...] = ()
