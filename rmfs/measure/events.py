"""What happened in a run besides motion: the events that a viewer replays.

The log begins with the stock of time zero and covers warm-up and measured time, so that the state
of every pod, order and station at any time follows from it. The page on the trace format describes
the columns.
"""

from __future__ import annotations

from enum import IntEnum
from struct import Struct
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.observer import Observer

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.observer import Observed
    from rmfs.world import World
    from rmfs.world.orders import Bundle, Order


class Happening(IntEnum):
    """Kinds of events; named in brackets which columns say what."""

    STOCK = 0
    """At time zero, units are on a pod (pod, sku, units)."""
    TASK = 1
    """TA gave a robot a task (robot, station, detail: the kind of task)."""
    ORDER_CREATED = 2
    """An order arrived (order, units)."""
    ORDER_ASSIGNED = 3
    """An order was put on a pick station (order, station, units)."""
    UNIT_PICKED = 4
    """A unit left a pod (order, sku, pod, robot, station, units: 1)."""
    ORDER_COMPLETED = 5
    """An order was completed (order, station, units)."""
    BUNDLE_CREATED = 6
    """A bundle arrived (order: the bundle's number, sku, units)."""
    BUNDLE_ASSIGNED = 7
    """A bundle was given pod and station (order: the bundle's number, sku, pod, station, units)."""
    BUNDLE_STORED = 8
    """A bundle went into its pod (order: its number, sku, pod, robot, station, units)."""
    VISIT_STARTED = 9
    """A pod reached a station (station, pod, robot)."""
    VISIT_ENDED = 10
    """A pod leaves a station (station, pod, robot)."""
    STATION_SWITCHED = 11
    """SA switched a station (station, units: 1 for on, 0 for off)."""
    CONTROLLER_EXCHANGED = 12
    """Another controller was installed (detail: problem=name)."""
    BATTERY_LEVEL = 13
    """What is in a battery, when a task begins and every minute (robot, units: thousandths)."""


COLUMNS = ("time_us", "kind", "robot", "pod", "station", "order", "sku", "units", "detail")
"""In the log all of them are integers: `kind` is a `Happening`, `detail` an index or -1."""


ROW = Struct(f"{len(COLUMNS)}q")
"""An event in the log's memory: its columns as 64-bit integers."""

_row = ROW.pack

KINDS = [kind.name.lower().replace("_", "-") for kind in Happening]
"""The kinds as they are written: words in the place of numbers."""


class EventLog(Observer):
    """Writes down all events of a run.

    Attributes
    ----------
    details
        The texts that the column `detail` points at.
    """

    def __init__(self) -> None:
        self.details: list[str] = []
        self._numbers: dict[str, int] = {}
        # 72 bytes an event, quick to write, and nothing for the collector to walk
        self._rows = bytearray()
        self._world: World | None = None

    def __len__(self) -> int:
        """Return the number of events."""
        return len(self._rows) // ROW.size

    def columns(self, known: int = 0) -> dict[str, NDArray[np.int64]]:
        """Return the events without the first `known`, one array per column."""
        rows = np.frombuffer(self._rows[known * ROW.size :], np.int64).reshape(-1, len(COLUMNS))
        return dict(zip(COLUMNS, rows.T, strict=True))

    def run_started(self, run: Observed) -> None:
        """Write down the stock, and what is in batteries."""
        self._world = run.world
        contained = run.world.inventory.contained
        for sku, pod in np.argwhere(contained).tolist():
            units = contained.item(sku, pod)
            self._rows.extend(_row(0, Happening.STOCK, -1, pod, -1, -1, sku, units, -1))
        self.sampled(0.0)

    def run_ended(self, time_s: float) -> None:
        """Let go of what is no record."""
        self._world = None

    def sampled(self, time_s: float) -> None:
        """What is in all batteries."""
        batteries = None if self._world is None else self._world.batteries
        if batteries is not None:
            for robot, share in enumerate(batteries.shares().tolist()):
                self._add_level(time_s, robot, share)

    def task_started(self, time_s: float, robot: int, kind: str, station: int) -> None:
        """A robot has a task."""
        now_us, detail = round(time_s * 1e6), self._detail(kind)
        self._rows.extend(_row(now_us, Happening.TASK, robot, -1, station, -1, -1, 0, detail))
        if self._world is not None and self._world.batteries is not None:
            self._add_level(time_s, robot, self._world.batteries.share(robot))

    def order_created(self, order: Order) -> None:
        """An order arrived."""
        self._add_order(order.created_s, Happening.ORDER_CREATED, order)

    def order_assigned(self, order: Order) -> None:
        """An order is on a station."""
        self._add_order(order.assigned_s, Happening.ORDER_ASSIGNED, order)

    def order_completed(self, order: Order) -> None:
        """An order is done."""
        self._add_order(order.completed_s, Happening.ORDER_COMPLETED, order)

    def unit_picked(
        self,
        time_s: float,
        order: Order,
        sku: int,
        pod: int,
        robot: int,
        station: int,
        late_bound: bool,
    ) -> None:
        """A unit left a pod."""
        now_us, picked = round(time_s * 1e6), Happening.UNIT_PICKED
        self._rows.extend(_row(now_us, picked, robot, pod, station, order.index, sku, 1, -1))

    def bundle_created(self, bundle: Bundle) -> None:
        """A bundle arrived."""
        self._add_bundle(bundle.created_s, Happening.BUNDLE_CREATED, bundle)

    def bundle_assigned(self, bundle: Bundle) -> None:
        """A bundle has pod and station."""
        self._add_bundle(bundle.assigned_s, Happening.BUNDLE_ASSIGNED, bundle)

    def bundle_stored(self, bundle: Bundle, robot: int) -> None:
        """A bundle is in its pod."""
        self._add_bundle(bundle.stored_s, Happening.BUNDLE_STORED, bundle, robot)

    def visit_started(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """A pod is at a station."""
        now_us = round(time_s * 1e6)
        self._rows.extend(_row(now_us, Happening.VISIT_STARTED, robot, pod, station, -1, -1, 0, -1))

    def visit_ended(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """A pod leaves a station."""
        now_us = round(time_s * 1e6)
        self._rows.extend(_row(now_us, Happening.VISIT_ENDED, robot, pod, station, -1, -1, 0, -1))

    def station_activated(self, time_s: float, station: int, active: bool) -> None:
        """A station was switched."""
        now_us, switched = round(time_s * 1e6), Happening.STATION_SWITCHED
        self._rows.extend(_row(now_us, switched, -1, -1, station, -1, -1, int(active), -1))

    def controller_exchanged(self, time_s: float, problem: str, name: str) -> None:
        """A controller was exchanged."""
        detail = self._detail(f"{problem}={name}")
        now_us, exchanged = round(time_s * 1e6), Happening.CONTROLLER_EXCHANGED
        self._rows.extend(_row(now_us, exchanged, -1, -1, -1, -1, -1, 0, detail))

    def _add_level(self, time_s: float, robot: int, share: float) -> None:
        now_us, level = round(time_s * 1e6), Happening.BATTERY_LEVEL
        thousandths = round(1000 * share)
        self._rows.extend(_row(now_us, level, robot, -1, -1, -1, -1, thousandths, -1))

    def _add_order(self, time_s: float, kind: Happening, order: Order) -> None:
        units = sum([line.units for line in order.lines])
        now_us = round(time_s * 1e6)
        self._rows.extend(_row(now_us, kind, -1, -1, order.station, order.index, -1, units, -1))

    def _add_bundle(self, time_s: float, kind: Happening, bundle: Bundle, robot: int = -1) -> None:
        now_us, units = round(time_s * 1e6), bundle.units
        whom = (robot, bundle.pod, bundle.station, bundle.index, bundle.sku)
        self._rows.extend(_row(now_us, kind, *whom, units, -1))

    def _detail(self, text: str) -> int:
        number = self._numbers.get(text)
        if number is None:
            number = self._numbers[text] = len(self.details)
            self.details.append(text)
        return number


def as_table(log: EventLog) -> dict[str, Any]:
    """Return the events as they are written: `kind` and `detail` as words."""
    import pandas as pd

    columns = log.columns()
    words = {"kind": KINDS, "detail": log.details}
    return {
        "time_us": columns["time_us"],
        **{name: columns[name].astype(np.int32) for name in COLUMNS[2:-1]},
        **{
            name: pd.Categorical.from_codes(columns[name], pd.Index(categories, dtype=object))
            for name, categories in words.items()
        },
    }
