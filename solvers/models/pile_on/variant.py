"""Variants of the pile-on models: how orders may be covered, and the weights of the objective."""

from __future__ import annotations

from dataclasses import dataclass, fields
from enum import Enum

from rmfs.solvers.models.checks import number


class Variant(Enum):
    """How the lines of an order may be covered (Xie, Thieme, Krenzler, Li 2021)."""

    WHOLE = "whole"
    """An order gets a slot only if the pods assigned to its station cover all its lines."""

    LATER = "later"
    """An order may take a slot with lines still open; pods called later cover them."""

    SPLIT_STATIONS = "split-stations"
    """The lines of an order may be spread over stations; all its lines are covered now."""

    SPLIT_TIME = "split-time"
    """One station covers some lines of an order; the rest stays in the backlog."""

    SPLIT_BOTH = "split-both"
    """Any station may cover any lines of an order; the rest stays in the backlog."""

    @property
    def many_stations(self) -> bool:
        """Whether an order may take slots at several stations."""
        return self in (Variant.SPLIT_STATIONS, Variant.SPLIT_BOTH)

    @property
    def leaves_backlog(self) -> bool:
        """Whether some lines of an order may stay in the backlog."""
        return self in (Variant.SPLIT_TIME, Variant.SPLIT_BOTH)


@dataclass(frozen=True)
class Weights:
    """The weights of the objective, in the unit of the travel cost.

    The defaults are those of the model M1G (Jiao et al. 2025), with travel in metres, plus values
    for weights that M1G does not have.

    Parameters
    ----------
    travel
        Cost per unit of travel, for the trip of a called pod to its station and that of a robot to
        the pod. Default 1.
    visit
        Cost per called pod in addition to its travel, for example for the hand-over at the station.
        Default 0.
    empty_slot
        Penalty per slot that stays empty. Default 1000.
    complete
        Reward per order that the pods assigned to its station cover in full. Default 40.
    unit
        Reward per unit of an order that is covered in full, so that large orders count for more.
        Default 0.
    prospects
        Whether `complete` and `unit` also reward prospects (as in M1G): orders that get no slot but
        could be filled from the pods that come. Such pods are useful for the next decision.
        Default: yes.
    open_unit
        Penalty per unit of open demand (of orders already at a station) that no pod covers. Default
        1000.
    open_line
        Penalty per uncovered line of an order that gets a slot in this decision; only in
        `Variant.LATER`. Default 100.
    line
        Reward per line covered, whatever its order. Default 0.
    part
        Penalty per slot that an order takes beyond its first, for the consolidation of its parts;
        only in variants that split orders over stations. Default 100.

    Raises
    ------
    ModelError
        If a weight is negative or not finite.
    """

    travel: float = 1.0
    visit: float = 0.0
    empty_slot: float = 1000.0
    complete: float = 40.0
    unit: float = 0.0
    prospects: bool = True
    open_unit: float = 1000.0
    open_line: float = 100.0
    line: float = 0.0
    part: float = 100.0

    def __post_init__(self) -> None:
        for field in fields(self):
            number(f"weights.{field.name}", getattr(self, field.name), low=0)
