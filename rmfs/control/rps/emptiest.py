"""RPS emptiest: chooses the pod with the lowest share of its capacity used or promised."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.rps.buffered import Sticky, StickyParameters

if TYPE_CHECKING:
    from rmfs.world.orders import Bundle


class Emptiest(Sticky[StickyParameters]):
    """Chooses the pod with the lowest share of its capacity used or promised.

    All pods with room are candidates, wherever they are. Ties go to the pod with the lowest number.
    By default, the chosen pod is kept for further bundles until one of them does not fit or a
    replenishment station serves the pod (`stick_to_pod`).
    """

    parameters_model = StickyParameters

    def choose_anew(self, bundle: Bundle) -> int:
        """Choose the emptiest of the pods with room; -1 if there is none."""
        inventory = self.view.inventory
        return self.best(bundle, inventory.load / inventory.capacity)
