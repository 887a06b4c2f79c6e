"""The tables of a run, each made from what the recorder wrote down."""

from __future__ import annotations

from collections.abc import Mapping
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
    from collections.abc import Iterable, Iterator

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


class Made(Mapping[str, "pd.DataFrame"]):
    """The tables but the footprint, each made when it is first asked for.

    Parameters
    ----------
    logs
        What happened.
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


def all_tables(run: Measured, report: CheckReport | None = None) -> dict[str, pd.DataFrame]:
    """Make every table of a run, by name; `report` fills the footprint's `collisions`."""
    return some_tables(run, MAKERS, report)


def some_tables(
    run: Measured, names: Iterable[str], report: CheckReport | None = None
) -> dict[str, pd.DataFrame]:
    """Make the footprint of a run and the tables of these names, and nothing that is not needed."""
    logs = Logs(run.recorder)
    made = Made(logs)
    return {"footprint": footprint(run, logs, made, report), **{name: made[name] for name in names}}
