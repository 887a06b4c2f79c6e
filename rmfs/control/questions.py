"""What may be asked of somebody outside."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.control.problems import Problem


@dataclass(frozen=True)
class Question:
    """What is to be decided.

    Attributes
    ----------
    kind
        `turn`: the next decision of a problem that the phase asks about. TA's questions: `pick
        pod`, `replenishment pod` and `next station` (PPS), `place` (PSA), `move` (repositioning).
    robot
        Whom a question of TA is about, or -1.
    stations
        The station of `pick pod` and `replenishment pod`; those to choose from of `next station`.
    """

    problem: Problem
    kind: str
    robot: int = -1
    stations: tuple[int, ...] = ()
