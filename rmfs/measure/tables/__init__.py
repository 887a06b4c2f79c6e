"""The tables of a run, each made from what the recorder wrote down."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.measure.tables.connections import connections as connections
from rmfs.measure.tables.connections import edges as edges
from rmfs.measure.tables.decisions import answers as answers
from rmfs.measure.tables.decisions import controllers as controllers
from rmfs.measure.tables.decisions import decisions as decisions
from rmfs.measure.tables.footprint import Measured as Measured
from rmfs.measure.tables.footprint import footprint as footprint
from rmfs.measure.tables.handled import bundles as bundles
from rmfs.measure.tables.handled import picks as picks
from rmfs.measure.tables.handled import visits as visits
from rmfs.measure.tables.logs import Logs as Logs
from rmfs.measure.tables.motion import heat as heat
from rmfs.measure.tables.motion import trips as trips
from rmfs.measure.tables.orders import orders as orders
from rmfs.measure.tables.robots import robots as robots
from rmfs.measure.tables.series import series as series
from rmfs.measure.tables.stations import stations as stations
from rmfs.measure.tables.stock import pods as pods
from rmfs.measure.tables.stock import skus as skus

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.checker import CheckReport

MAKERS = {
    "series": series,
    "stations": stations,
    "orders": orders,
    "picks": picks,
    "bundles": bundles,
    "visits": visits,
    "trips": trips,
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
"""How each table but the footprint is made from what happened."""


def all_tables(run: Measured, report: CheckReport | None = None) -> dict[str, pd.DataFrame]:
    """Make every table of a run, by name; `report` fills the footprint's `collisions`."""
    logs = Logs(run.recorder)
    made = {name: make(logs) for name, make in MAKERS.items()}
    return {"footprint": footprint(run, logs, made, report), **made}
