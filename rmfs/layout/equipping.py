"""Creates pick and replenishment stations from queues and layout parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.layout.model import PickStation, ReplenishmentStation

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rmfs.layout.drawn.parameters import Equipment
    from rmfs.layout.parameters import LayoutParameters

    Given = LayoutParameters | Equipment
    Ranked = Iterable[tuple[tuple[int, ...], int]]
    """The queue of each station, head first, and its activation rank."""


def pick_stations(ranked: Ranked, given: Given) -> tuple[PickStation, ...]:
    """Return the pick stations.

    Parameters
    ----------
    ranked
        For each station, its queue (head first) and its rank in the order of activation.
    given
        Parameters of the layout.
    """
    return tuple(
        PickStation(
            waypoint=queue[0],
            queue=queue,
            radius_m=given.station_radius_m,
            order_slots=given.order_slots,
            unit_transfer_s=given.unit_transfer_s,
            unit_pick_s=given.unit_pick_s,
            activation=rank,
        )
        for queue, rank in ranked
    )


def replenishment_stations(ranked: Ranked, given: Given) -> tuple[ReplenishmentStation, ...]:
    """Return the replenishment stations; the parameters are those of `pick_stations`."""
    return tuple(
        ReplenishmentStation(
            waypoint=queue[0],
            queue=queue,
            radius_m=given.station_radius_m,
            capacity=given.replenishment_station_capacity,
            bundle_transfer_s=given.bundle_transfer_s,
            activation=rank,
        )
        for queue, rank in ranked
    )
