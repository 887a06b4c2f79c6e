"""The order in which stations are switched on."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.control.view import View


def activation_order(view: View, pick: bool) -> list[int]:
    """Return the numbers of the stations of one kind in the order in which they are switched on.

    Stations are sorted by activation number in the layout, then by number.

    Parameters
    ----------
    pick
        Whether pick stations are returned; if false, replenishment stations.
    """
    layout = view.layout
    if pick:
        ranks = [plan.activation for plan in layout.pick_stations]
        numbers = [station.index for station in view.pick_stations]
    else:
        ranks = [plan.activation for plan in layout.replenishment_stations]
        numbers = [station.index for station in view.replenishment_stations]
    return [number for _, number in sorted(zip(ranks, numbers, strict=True))]
