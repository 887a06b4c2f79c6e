"""The sites from whose runs the questions of the library are drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping

LOADS = ("backlog", "arrivals")
"""Kinds of demand."""


@dataclass(frozen=True)
class Site:
    """A site of a given size, with the runs from which questions are drawn.

    Attributes
    ----------
    layout
        Shipped layout.
    scenarios
        Shipped scenario for each kind of demand.
    set
        Overridden parameters.
    duration_s
        Simulated time in s.
    seeds
        Seeds of its runs.
    """

    layout: str
    scenarios: Mapping[str, str]
    set: Mapping[str, Any]
    duration_s: float
    seeds: tuple[int, ...]


SITES: Mapping[str, Site] = {
    "small": Site("small", {"backlog": "small", "arrivals": "small-arrivals"}, {}, 1800.0, (1, 2)),
    "medium": Site("default-32", {"backlog": "default", "arrivals": "poisson"}, {}, 900.0, (1, 2)),
    "real": Site("large", {"backlog": "large", "arrivals": "large-arrivals"}, {}, 600.0, (1,)),
    "double": Site(
        "large",
        {"backlog": "large", "arrivals": "large-arrivals"},
        {
            "layout.robots": 90,
            "layout.horizontal_aisles": 24,
            "layout.pick_stations.east": 12,
            "layout.pick_stations.south": 4,
            "layout.pick_stations.north": 4,
            "layout.pick_stations.west": 4,
            "layout.replenishment_stations.west": 8,
        },
        300.0,
        (1,),
    ),
}
"""The sizes, by robots and pods: 10 and 100; 32 and 428; 45 and 1,200 with 12 pick stations; 90 and
2,307 with 24."""

TWICE: Mapping[str, Mapping[str, Any]] = {
    "backlog": {"scenario.demand.orders": 400, "scenario.replenishment.bundles": 1200},
    "arrivals": {"scenario.demand.orders_per_h": 3200, "scenario.demand.initial_orders": 400},
}
"""Parameters of the demand at the size `double`, by kind of demand: twice those of `real`."""
