"""Pick order assignment (POA): which order goes to which pick station, and when."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, TypeVar

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem, Trigger

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.asks import Ask, By
    from rmfs.control.decisions import AssignLines, AssignOrder, QueueOrder

P = TypeVar("P", bound=Parameters)


class PickOrderAssignment(Controller[P]):
    """Assigns orders of the backlog (`view.orders`) to pick stations with free slots.

    Each decision that `decide` yields is applied before `decide` continues: by then, an assigned
    order has left the backlog and occupies its slot. Orders not chosen wait until the next call. A
    controller may also put orders into the pool of a station (`QueueOrder`), so that pods can be
    fetched for them before a slot is free.
    """

    problem = Problem.POA
    triggers = frozenset(
        {
            Trigger.START,
            Trigger.NEW_ORDER,
            Trigger.ORDER_CUT,
            Trigger.ORDER_COMPLETED,
            Trigger.BUNDLE_STORED,
            Trigger.STATION_SWITCHED,
        }
    )

    @abstractmethod
    def decide(self) -> Iterator[AssignOrder | AssignLines | QueueOrder | Ask[Any] | By[Any]]:
        """Yield decisions until no further order should be assigned or put into a pool now."""
