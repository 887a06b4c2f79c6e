"""The tables of a run except the footprint, each made from the recorded data."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from rmfs.measure.tables.bundle_lines import BUNDLE_LINES as BUNDLE_LINES
from rmfs.measure.tables.bundle_lines import bundle_lines as bundle_lines
from rmfs.measure.tables.connections import CONNECTIONS as CONNECTIONS
from rmfs.measure.tables.connections import EDGES as EDGES
from rmfs.measure.tables.connections import connections as connections
from rmfs.measure.tables.connections import edges as edges
from rmfs.measure.tables.decisions import ANSWERS as ANSWERS
from rmfs.measure.tables.decisions import CONTROLLERS as CONTROLLERS
from rmfs.measure.tables.decisions import DECISIONS as DECISIONS
from rmfs.measure.tables.decisions import answers as answers
from rmfs.measure.tables.decisions import controllers as controllers
from rmfs.measure.tables.decisions import decisions as decisions
from rmfs.measure.tables.delays import DELAYS as DELAYS
from rmfs.measure.tables.delays import delays as delays
from rmfs.measure.tables.handled import BUNDLES as BUNDLES
from rmfs.measure.tables.handled import PICKS as PICKS
from rmfs.measure.tables.handled import VISITS as VISITS
from rmfs.measure.tables.handled import bundles as bundles
from rmfs.measure.tables.handled import picks as picks
from rmfs.measure.tables.handled import visits as visits
from rmfs.measure.tables.logs import Logs as Logs
from rmfs.measure.tables.motion import HEAT as HEAT
from rmfs.measure.tables.motion import PLANS as PLANS
from rmfs.measure.tables.motion import TRIPS as TRIPS
from rmfs.measure.tables.motion import heat as heat
from rmfs.measure.tables.motion import plans as plans
from rmfs.measure.tables.motion import trips as trips
from rmfs.measure.tables.order_lines import ORDER_LINES as ORDER_LINES
from rmfs.measure.tables.order_lines import order_lines as order_lines
from rmfs.measure.tables.orders import ORDERS as ORDERS
from rmfs.measure.tables.orders import orders as orders
from rmfs.measure.tables.packing import PARCELS as PARCELS
from rmfs.measure.tables.packing import TOTES as TOTES
from rmfs.measure.tables.packing import parcels as parcels
from rmfs.measure.tables.packing import totes as totes
from rmfs.measure.tables.pickers import PICKERS as PICKERS
from rmfs.measure.tables.pickers import pickers as pickers
from rmfs.measure.tables.priorities import PRIORITIES as PRIORITIES
from rmfs.measure.tables.priorities import priorities as priorities
from rmfs.measure.tables.robots import ROBOTS as ROBOTS
from rmfs.measure.tables.robots import robots as robots
from rmfs.measure.tables.series import SERIES as SERIES
from rmfs.measure.tables.series import series as series
from rmfs.measure.tables.stations import STATIONS as STATIONS
from rmfs.measure.tables.stations import stations as stations
from rmfs.measure.tables.stock import PODS as PODS
from rmfs.measure.tables.stock import SKUS as SKUS
from rmfs.measure.tables.stock import pods as pods
from rmfs.measure.tables.stock import skus as skus

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import pandas as pd

    from rmfs.measure.columns import Column

MAKERS = {
    "series": series,
    "stations": stations,
    "orders": orders,
    "order_lines": order_lines,
    "priorities": priorities,
    "delays": delays,
    "parcels": parcels,
    "totes": totes,
    "picks": picks,
    "pickers": pickers,
    "bundles": bundles,
    "bundle_lines": bundle_lines,
    "visits": visits,
    "trips": trips,
    "plans": plans,
    "connections": connections,
    "robots": robots,
    "pods": pods,
    "skus": skus,
    "heat": heat,
    "edges": edges,
    "decisions": decisions,
    "answers": answers,
    "controllers": controllers,
}
"""The function that makes each table except the footprint."""

DECLARED: dict[str, Sequence[Column]] = {
    "series": SERIES,
    "stations": STATIONS,
    "orders": ORDERS,
    "order_lines": ORDER_LINES,
    "priorities": PRIORITIES,
    "delays": DELAYS,
    "parcels": PARCELS,
    "totes": TOTES,
    "picks": PICKS,
    "pickers": PICKERS,
    "bundles": BUNDLES,
    "bundle_lines": BUNDLE_LINES,
    "visits": VISITS,
    "trips": TRIPS,
    "plans": PLANS,
    "connections": CONNECTIONS,
    "robots": ROBOTS,
    "pods": PODS,
    "skus": SKUS,
    "heat": HEAT,
    "edges": EDGES,
    "decisions": DECISIONS,
    "answers": ANSWERS,
    "controllers": CONTROLLERS,
}
"""The columns of these tables."""


class Made(Mapping[str, "pd.DataFrame"]):
    """The tables of a run by name, except the footprint; each is made when it is first accessed.

    Parameters
    ----------
    logs
        The recorded data of the run.
    """

    def __init__(self, logs: Logs) -> None:
        self._logs = logs
        self._made: dict[str, pd.DataFrame] = {}

    def __getitem__(self, name: str) -> pd.DataFrame:
        if name not in self._made:
            self._made[name] = MAKERS[name](self._logs)
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(MAKERS)

    def __len__(self) -> int:
        return len(MAKERS)
