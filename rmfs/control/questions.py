"""Questions that can be decided outside the simulation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.control.problems import Problem


@dataclass(frozen=True)
class Question:
    """A question that is answered outside the simulation.

    Attributes
    ----------
    kind
        `turn`: the next decision of a problem. Questions of TA: `pick pod`, `replenishment pod` and
        `next station` (PPS), `place` (PSA), `move` (repositioning).
    robot
        The robot that a question of TA concerns; -1 for a turn.
    stations
        For `pick pod` and `replenishment pod`, the station; for `next station`, the options.
    """

    problem: Problem
    kind: str
    robot: int = -1
    stations: tuple[int, ...] = ()
