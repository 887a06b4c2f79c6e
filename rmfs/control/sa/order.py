"""The order in which stations are switched on."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.control.view import View


def activation_order(view: View, pick: bool) -> list[int]:
    """Stations of one kind by their activation number in the layout, ties by number.

    Parameters
    ----------
    pick
        Pick stations; otherwise replenishment stations.
    """
    first = 0 if pick else len(view.pick_stations)
    given = view.layout.pick_stations if pick else view.layout.replenishment_stations
    numbers = [station.activation for station in given]
    return sorted(range(first, first + len(given)), key=lambda index: numbers[index - first])
