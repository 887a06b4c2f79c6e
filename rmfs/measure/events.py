"""All events of a run except motion; the viewer replays them together with the motion.

The log starts with the stock at time zero and covers warm-up and measured time, so that the state
of every pod, order and station at any time can be reconstructed. The page on the trace format
describes the columns.
"""

from __future__ import annotations

from collections import Counter
from enum import IntEnum
from itertools import islice
from math import isfinite
from struct import Struct
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.observer import Observer
from rmfs.world.tasks import PickTask

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.observer import Observed
    from rmfs.world import World
    from rmfs.world.orders import Bundle, Order
    from rmfs.world.tasks import Pick


class Happening(IntEnum):
    """Kinds of events; the description of each kind lists in brackets the columns that it uses."""

    STOCK = 0
    """At time zero, units are on a pod (pod, sku, units)."""
    TASK = 1
    """TA gave a robot a task (robot, station, detail: the kind of task)."""
    ORDER_CREATED = 2
    """An order arrived (order, units)."""
    ORDER_ASSIGNED = 3
    """An order was assigned to a pick station (order, station, units)."""
    UNIT_PICKED = 4
    """A unit left a pod (order, sku, pod, robot, station, units: 1)."""
    ORDER_COMPLETED = 5
    """An order was completed (order, station, units)."""
    BUNDLE_CREATED = 6
    """A bundle arrived (order: the bundle's number, sku, units)."""
    BUNDLE_ASSIGNED = 7
    """A bundle was assigned to a pod and a station (order: the bundle's number, sku, pod, station,
    units)."""
    BUNDLE_STORED = 8
    """A bundle went into its pod (order: the bundle's number, sku, pod, robot, station, units)."""
    VISIT_STARTED = 9
    """A pod reached a station (station, pod, robot)."""
    VISIT_ENDED = 10
    """A pod leaves a station (station, pod, robot)."""
    STATION_SWITCHED = 11
    """SA switched a station (station, units: 1 for on, 0 for off)."""
    CONTROLLER_EXCHANGED = 12
    """Another controller was installed (detail: problem=name)."""
    BATTERY_LEVEL = 13
    """Level of a robot's battery: at time zero, at the start of each of its tasks, and every minute
    after the warm-up (robot, units: thousandths of the capacity)."""
    ORDER_LINE = 14
    """An order has a line for units of a SKU (order, sku, units). If a station is given, the line
    belongs to the part of a split order that was assigned to this station."""
    ORDER_DUE = 15
    """Due time of an order (order, units: whole seconds since the start of the run)."""
    ORDER_CUT = 16
    """Units of an order were cut because stock could not serve them (order, units: those that the
    order keeps). The lines that remain follow as `ORDER_LINE`."""
    ORDER_CANCELLED = 17
    """An order was cancelled because stock could not serve it (order)."""
    PART_COMPLETED = 18
    """A part of a split order left its slot (order, station)."""
    UNITS_BOUND = 19
    """Units of an order were bound to a pod that is brought to a station for them (order, sku,
    pod, robot, station, units). Each pick of such a unit reduces the number bound by one."""
    UNITS_UNBOUND = 20
    """Units that were bound to a pod were released from it (columns as in `UNITS_BOUND`)."""


COLUMNS = ("time_us", "kind", "robot", "pod", "station", "order", "sku", "units", "detail")
"""Columns of the log, all integers: `kind` is a `Happening`, `detail` an index into
`EventLog.details` or -1."""


ROW = Struct(f"{len(COLUMNS)}q")
"""An event in memory: its columns as 64-bit integers."""

_row = ROW.pack

MOST = 2**31 - 1
"""Largest number that fits into the columns of a file that have the type int32."""

KINDS = [kind.name.lower().replace("_", "-") for kind in Happening]
"""The kinds as words, as they are written to files."""


Unit = tuple[int, int]
"""A unit that is bound to a pod: its order and its SKU."""


class _Bound:
    """The units of a pick task: those bound to its pod, those picked or released, and the rest."""

    __slots__ = ("bound", "left", "picked", "task")

    def __init__(self, task: PickTask) -> None:
        self.task = task
        self.left = 0
        self.bound: list[Unit] = []
        self.picked: list[Unit] = []

    def look(self) -> tuple[Happening, dict[Unit, int]]:
        """Return whether units were bound or unbound since the last call, and how many of each."""
        picks = self.task.picks
        count = len(picks) - self.left
        self.left += count
        if count < 0:
            lost = Counter(self.bound)
            lost.subtract(self.picked)
            lost.subtract([_unit(pick) for pick in picks])
            self.picked += lost.elements()
            return Happening.UNITS_UNBOUND, {unit: n for unit, n in lost.items() if n > 0}
        found: dict[Unit, int] = {}
        # what is bound later stands last
        for pick in islice(reversed(picks), count):
            unit = _unit(pick)
            found[unit] = found.get(unit, 0) + 1
            self.bound.append(unit)
        return Happening.UNITS_BOUND, found


def _unit(pick: Pick) -> Unit:
    return pick.line.order.index, pick.line.sku


class EventLog(Observer):
    """Records all events of a run except motion.

    Attributes
    ----------
    details
        The texts to which the column `detail` refers by their indices.
    """

    def __init__(self) -> None:
        self.details: list[str] = []
        self._numbers: dict[str, int] = {}
        # 72 bytes per event, fast to write, and nothing for the garbage collector to traverse
        self._rows = bytearray()
        self._world: World | None = None
        self._bound: dict[int, _Bound] = {}

    def __len__(self) -> int:
        """Return the number of events."""
        return len(self._rows) // ROW.size

    def columns(self, known: int = 0) -> dict[str, NDArray[np.int64]]:
        """Return all events except the first `known` ones, as one array per column."""
        rows = np.frombuffer(self._rows[known * ROW.size :], np.int64).reshape(-1, len(COLUMNS))
        return dict(zip(COLUMNS, rows.T, strict=True))

    def run_started(self, run: Observed) -> None:
        """Record the initial stock and the initial levels of batteries."""
        self._world = run.world
        contained = run.world.inventory.contained
        for sku, pod in np.argwhere(contained).tolist():
            units = contained.item(sku, pod)
            self._rows.extend(_row(0, Happening.STOCK, -1, pod, -1, -1, sku, units, -1))
        self.sampled(0.0)

    def run_ended(self, time_s: float) -> None:
        """Release references to the run."""
        self._world = None
        self._bound.clear()

    def sampled(self, time_s: float) -> None:
        """Record the levels of all batteries."""
        batteries = None if self._world is None else self._world.batteries
        if batteries is not None:
            for robot, share in enumerate(batteries.shares().tolist()):
                self._add_level(time_s, robot, share)

    def task_started(self, time_s: float, robot: int, kind: str, station: int) -> None:
        """Record that a robot was given a task."""
        now_us, detail = round(time_s * 1e6), self._detail(kind)
        self._rows.extend(_row(now_us, Happening.TASK, robot, -1, station, -1, -1, 0, detail))
        if self._world is not None and self._world.batteries is not None:
            self._add_level(time_s, robot, self._world.batteries.share(robot))
        if kind == PickTask.kind:
            self.picks_changed(time_s, robot)

    def picks_changed(self, time_s: float, robot: int) -> None:
        """Record the units bound to a robot's pod, or unbound from it, since the last call."""
        if self._world is None:
            return
        task = self._world.robots[robot].task
        if not isinstance(task, PickTask):
            return
        known = self._bound.get(robot)
        if known is None or known.task is not task:
            known = self._bound[robot] = _Bound(task)
        kind, changed = known.look()
        now_us, whom = round(time_s * 1e6), (robot, task.pod, task.station)
        for (order, sku), units in changed.items():
            self._rows.extend(_row(now_us, kind, *whom, order, sku, units, -1))

    def order_created(self, order: Order) -> None:
        """Record the arrival of an order."""
        self._add_order(order.created_s, Happening.ORDER_CREATED, order)
        self._add_lines(order.created_s, order)
        if isfinite(order.due_s):
            due_s, index = min(max(round(order.due_s), 0), MOST), order.index
            now_us, due = round(order.created_s * 1e6), Happening.ORDER_DUE
            self._rows.extend(_row(now_us, due, -1, -1, -1, index, -1, due_s, -1))

    def order_cut(self, order: Order) -> None:
        """Record that units of an order were cut because stock could not serve them."""
        self._add_order(self._now_s, Happening.ORDER_CUT, order)
        self._add_lines(self._now_s, order)

    def order_cancelled(self, order: Order) -> None:
        """Record that an order was cancelled."""
        self._add_order(order.cancelled_s, Happening.ORDER_CANCELLED, order)

    def order_assigned(self, order: Order) -> None:
        """Record that an order was assigned to a station."""
        # lines may join a part that has been there for a while: its own time is that of the first
        self._add_order(self._now_s, Happening.ORDER_ASSIGNED, order)
        if order.whole is not None:
            self._add_lines(self._now_s, order)

    def slot_freed(self, order: Order) -> None:
        """Record that a part of a split order left its slot; ignore orders that are not split."""
        if order.whole is not None or order.parts:
            self._add_order(self._now_s, Happening.PART_COMPLETED, order)

    def order_completed(self, order: Order) -> None:
        """Record that an order was completed."""
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
        """Record that a unit was picked."""
        now_us, picked = round(time_s * 1e6), Happening.UNIT_PICKED
        known = self._bound.get(robot)
        if known is not None:
            known.left -= 1
            known.picked.append((order.index, sku))
        self._rows.extend(_row(now_us, picked, robot, pod, station, order.index, sku, 1, -1))

    def bundle_created(self, bundle: Bundle) -> None:
        """Record the arrival of a bundle."""
        self._add_bundle(bundle.created_s, Happening.BUNDLE_CREATED, bundle)

    def bundle_assigned(self, bundle: Bundle) -> None:
        """Record that a bundle was assigned to a pod and a station."""
        self._add_bundle(bundle.assigned_s, Happening.BUNDLE_ASSIGNED, bundle)

    def bundle_stored(self, bundle: Bundle, robot: int) -> None:
        """Record that a bundle was stored."""
        self._add_bundle(bundle.stored_s, Happening.BUNDLE_STORED, bundle, robot)

    def visit_started(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """Record that a pod reached a station."""
        now_us = round(time_s * 1e6)
        self._rows.extend(_row(now_us, Happening.VISIT_STARTED, robot, pod, station, -1, -1, 0, -1))

    def visit_ended(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """Record that a pod leaves a station."""
        now_us = round(time_s * 1e6)
        self._rows.extend(_row(now_us, Happening.VISIT_ENDED, robot, pod, station, -1, -1, 0, -1))

    def station_activated(self, time_s: float, station: int, active: bool) -> None:
        """Record that a station was switched on or off."""
        now_us, switched = round(time_s * 1e6), Happening.STATION_SWITCHED
        self._rows.extend(_row(now_us, switched, -1, -1, station, -1, -1, int(active), -1))

    def controller_exchanged(self, time_s: float, problem: str, name: str) -> None:
        """Record that a controller was exchanged."""
        detail = self._detail(f"{problem}={name}")
        now_us, exchanged = round(time_s * 1e6), Happening.CONTROLLER_EXCHANGED
        self._rows.extend(_row(now_us, exchanged, -1, -1, -1, -1, -1, 0, detail))

    @property
    def _now_s(self) -> float:
        assert self._world is not None
        return self._world.now_s

    def _add_level(self, time_s: float, robot: int, share: float) -> None:
        now_us, level = round(time_s * 1e6), Happening.BATTERY_LEVEL
        thousandths = round(1000 * share)
        self._rows.extend(_row(now_us, level, robot, -1, -1, -1, -1, thousandths, -1))

    def _add_order(self, time_s: float, kind: Happening, order: Order) -> None:
        # a split order is complete with the lines of all its parts
        lines = order.all_lines if kind is Happening.ORDER_COMPLETED else order.lines
        units = sum([line.units for line in lines])
        now_us = round(time_s * 1e6)
        self._rows.extend(_row(now_us, kind, -1, -1, order.station, order.index, -1, units, -1))

    def _add_lines(self, time_s: float, order: Order) -> None:
        now_us, kind = round(time_s * 1e6), Happening.ORDER_LINE
        of = (order.station, order.index)
        for line in order.lines:
            self._rows.extend(_row(now_us, kind, -1, -1, *of, line.sku, line.units, -1))

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
    """Return the columns of the events as written to files, with `kind` and `detail` as text."""
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
