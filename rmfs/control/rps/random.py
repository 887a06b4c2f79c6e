"""RPS random: draws a pod with room."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.rps.buffered import Sticky, StickyParameters

if TYPE_CHECKING:
    from rmfs.world.orders import Bundle

_DRAWS = 16
"""Number of draws from all pods, before a draw from the pods with room."""


class RandomPod(Sticky[StickyParameters]):
    """Draws one of all pods with room for the bundle, wherever they are.

    By default, the drawn pod is kept for further bundles until one of them does not fit or a
    replenishment station serves the pod (`stick_to_pod`).
    """

    parameters_model = StickyParameters

    def choose_anew(self, bundle: Bundle) -> int:
        """Draw a pod with room; -1 if there is none."""
        inventory = self.view.inventory
        pods = len(inventory.capacity)
        for _ in range(_DRAWS):
            pod = self.draw(pods)
            if inventory.load[pod] + bundle.space <= inventory.capacity[pod]:
                return pod
        fitting = (inventory.load + bundle.space <= inventory.capacity).nonzero()[0]
        return int(fitting[self.draw(len(fitting))]) if len(fitting) else -1
