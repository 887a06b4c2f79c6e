"""RPS random: chooses a pod with room at random."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.rps.buffered import Sticky, StickyParameters

if TYPE_CHECKING:
    from rmfs.world.orders import Bundle

_DRAWS = 16
"""Maximum number of draws from all pods. If none of the pods drawn has room, a pod is drawn from
those with room."""


class RandomPod(Sticky[StickyParameters]):
    """Chooses a random pod with room for the bundle.

    All pods with room are candidates, wherever they are. By default, the chosen pod is kept for
    further bundles until one of them does not fit or a replenishment station serves the pod
    (`stick_to_pod`).
    """

    parameters_model = StickyParameters

    def choose_anew(self, bundle: Bundle) -> int:
        """Choose a pod with room at random; -1 if there is none."""
        inventory = self.view.inventory
        pods = len(inventory.capacity)
        for _ in range(_DRAWS):
            pod = self.draw(pods)
            if inventory.load[pod] + bundle.space <= inventory.capacity[pod]:
                return pod
        fitting = (inventory.load + bundle.space <= inventory.capacity).nonzero()[0]
        return int(fitting[self.draw(len(fitting))]) if len(fitting) else -1
