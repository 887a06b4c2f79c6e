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
    """A site, with the settings of the runs from which questions are drawn.

    Attributes
    ----------
    layout
        Name of a shipped layout.
    scenarios
        Name of a shipped scenario for each kind of demand.
    set
        Parameters of layout and scenario that are changed, with their new values.
    duration_s
        Simulated time of each run, in s.
    seeds
        Seeds of the runs; each is used with every kind of demand.
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
"""The sites by size. Robots and pods: `small` 10 and 100; `medium` 32 and 428; `real` 45 and 1,200,
with 12 pick stations; `double` 90 and 2,307, with 24 pick stations."""

TWICE: Mapping[str, Mapping[str, Any]] = {
    "backlog": {"scenario.demand.orders": 400, "scenario.replenishment.bundles": 1200},
    "arrivals": {"scenario.demand.orders_per_h": 3200, "scenario.demand.initial_orders": 400},
}
"""Parameters of the demand at the size `double`, by kind of demand: twice those of `real`."""
