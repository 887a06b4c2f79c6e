"""The observer that records a run.

During the run, it only appends rows to logs; `rmfs.measure.tables` makes the tables afterwards. The
logs also cover the warm-up, because work that starts in it may end in the measured time; most
tables cover only the measured time.
"""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING

from rmfs.control.solutions import to_text
from rmfs.measure.energy import EnergyLog
from rmfs.measure.log import Log
from rmfs.measure.packing import PackingLog
from rmfs.measure.pickers import PickerLog
from rmfs.observer import Observer
from rmfs.world import tasks
from rmfs.world.tasks import VisitTask

if TYPE_CHECKING:
    from typing import Any

    from numpy.typing import NDArray

    from rmfs.control.asks import Call
    from rmfs.layout.model import Layout
    from rmfs.observer import MotionCounts, Observed, Troubles
    from rmfs.scenario.streams import BundleStream, OrderStream
    from rmfs.world.orders import Bundle, Order
    from rmfs.world.pickers import Handled
    from rmfs.world.put_wall import Parcel
    from rmfs.world.world import World


TASKS = tuple(task.kind for task in tasks.TASKS)
"""Kinds of tasks in every warehouse, indexed by their number in the logs."""


class Recorder(Observer):
    """Records the data from which a run's tables are made.

    Attributes
    ----------
    start_s, end_s
        Start and end of the measured time, in s since the start of the run.
    order_stream, bundle_stream
        The orders and bundles read from a file; None if the scenario generates them.
    units
        Picked units.
    lines
        Finished order lines. `assigned_s` is when the line was assigned to its station; the lines
        of a split order may be assigned at different times. For the last unit of the line, `time_s`
        is when its pick started, `end_s` when its handling ended, and `robot` the robot that
        brought its pod.
    orders
        Completed and cancelled orders; rows as in `order_row`.
    open_orders
        Orders neither completed nor cancelled, whether assigned to a station or not, by index.
    slots
        Periods in which an order, or a part of one, was assigned to a pick station; `end_s` is nan
        if it was still there at the end of the run.
    bundles
        Stored bundles; rows as in `bundle_row`, with the robot as an additional last column.
    open_bundles
        Bundles not yet stored, by index.
    visits
        Visits to stations; `pod` is -1 if the robot carried no pod, and `end_s` is nan if the visit
        was still in progress at the end of the run.
    busy
        Periods in which stations were busy, for example with a unit, a bundle or a charging robot.
    tasks
        Tasks started; `kind` is an index into `TASKS`, or a larger number for visits to stations
        other than pick and replenishment stations.
    lifts
        Lifts of pods.
    calls
        Calls in which a controller made decisions itself, without an optimiser; `problem` is an
        index into `problems`.
    problems
        Decision problems, in the order in which they first occur in `calls`.
    asked
        By decision problem, the number of calls of its controller since the end of the warm-up, and
        their total wall time (s).
    questions
        Questions to optimisers, in order.
    solutions
        Solutions that optimisers found, as JSON text, by the number of the question.
    by_rule
        By decision problem, how many decisions its controller has made by its own rule since the
        end of the warm-up, although it has an optimiser.
    switches
        Events at which a station was switched on or off.
    early_trips
        Trips that ended before the measured time.
    samples
        For each minute of the measured time: when it ended (s), and the fleet's distances (m) and
        times in each state (s), as totals since the end of the warm-up.
    plans
        Searches for plans of trips; empty if plans take no simulated time.
    energy
        Energy drawn and charged by robots.
    packing
        Totes that have left the pick stations, and the orders (parcels) to which they belong.
    pickers
        Presence of pickers at the pick stations, and the units that they handled.
    charge_kinds
        Values of `kind` in `tasks` for tasks in which robots charge.
    """

    def __init__(self) -> None:
        self.layout: Layout
        self.world: World
        self.order_stream: OrderStream | None = None
        self.bundle_stream: BundleStream | None = None
        self.traffic: MotionCounts
        self.start_s = 0.0
        self.end_s = nan
        self.units = Log(
            **{"time_s": "f8", "order": "i4", "sku": "i4", "pod": "i4"},
            **{"robot": "i2", "station": "i2", "late_bound": "?"},
        )
        self.lines = Log(
            **{"time_s": "f8", "sku": "i4", "station": "i2"},
            **{"order": "i4", "robot": "i2", "assigned_s": "f8", "end_s": "f8"},
        )
        self.orders = Log(
            **{"order": "i4", "station": "i2", "lines": "i4", "units": "i4", "in_file": "i4"},
            priority="i1",
            **{"created_s": "f8", "due_s": "f8", "assigned_s": "f8", "completed_s": "f8"},
            **{"cancelled_s": "f8", "units_cut": "i4"},
        )
        self.open_orders: dict[int, Order] = {}
        self.slots = Log(station="i2", begin_s="f8", end_s="f8")
        self.bundles = Log(
            **{"time_s": "f8", "created_s": "f8", "assigned_s": "f8", "sku": "i4", "units": "i4"},
            **{"space": "f8", "pod": "i4", "station": "i2", "in_file": "i4", "robot": "i2"},
        )
        self.open_bundles: dict[int, Bundle] = {}
        self.visits = Log(station="i2", pod="i4", robot="i2", begin_s="f8", end_s="f8")
        self.busy = Log(station="i2", begin_s="f8", end_s="f8")
        self.tasks = Log(begin_s="f8", robot="i2", kind="i1")
        self.lifts = Log(time_s="f8", pod="i4", robot="i2")
        self.calls = Log(time_s="f8", problem="i1", decisions="i4", wall_s="f8")
        self.problems: list[str] = []
        self.asked: dict[str, list[float]] = {}
        self.questions: list[Call] = []
        self.solutions: dict[int, str] = {}
        self.by_rule: dict[str, int] = {}
        self.switches = Log(time_s="f8", station="i2", active="?")
        self.samples: list[tuple[float, dict[str, float]]] = []
        self.energy = EnergyLog()
        self.packing = PackingLog()
        self.pickers = PickerLog()
        self.charge_kinds: list[int] = []
        self.stored_space_start = 0.0
        self.motion: dict[str, NDArray[Any]] = {}
        self.heat: dict[str, NDArray[Any]] = {}
        self.trips: dict[str, NDArray[Any]] = {}
        self.edges: dict[str, NDArray[Any]] = {}
        self.plans: dict[str, NDArray[Any]] = {}
        self.counters: dict[str, float] = {}
        self.early_trips: dict[str, NDArray[Any]] = {}
        self._picked_by = -1
        self._busy_until: dict[int, float] = {}
        self._at_station: dict[int, tuple[float, int, int]] = {}
        self._in_slot: dict[tuple[int, int], float] = {}
        self._line_assigned: dict[tuple[int, int], float] = {}
        self._before = {"order_redraws": 0, "orders_short": 0}
        self._disturbances: Troubles

    @property
    def duration_s(self) -> float:
        """Length of the measured time, in s."""
        return self.end_s - self.start_s

    def run_started(self, run: Observed) -> None:
        """Keep references to the parts of the run, and start the logs that the scenario needs."""
        self.layout, self.world, self.traffic = run.layout, run.world, run.traffic
        self.order_stream, self.bundle_stream = run.order_stream, run.bundle_stream
        self._disturbances = run.disturbances
        self.due = run.scenario.orders.due
        if run.scenario.energy is not None:
            self.energy.begin(run.traffic, run.layout.robots, run.world.batteries)
        if run.scenario.packing is not None:
            self.packing.begin(run.scenario.packing, run.world)
        if run.world.staff is not None:
            self.pickers.begin(run.world.staff)
        visits = [kind.part("task", VisitTask).kind for kind in run.layout.other_kinds]
        self.charge_kinds = [n for n, kind in enumerate(visits, len(TASKS)) if kind == "charge"]
        self._task_number = {kind: number for number, kind in enumerate([*TASKS, *visits])}
        self.stored_space_start = run.world.inventory.stored_space

    def warmup_ended(self, time_s: float) -> None:
        """Start measuring."""
        self.start_s = time_s
        self.early_trips = self.traffic.trips()
        self.asked.clear()
        self.by_rule.clear()
        if time_s > 0:  # without warm-up, orders that arrive at time 0 are measured
            self._before = self._order_counts()

    def run_ended(self, time_s: float) -> None:
        """Store the counts of `traffic`, and record visits and other periods still in progress."""
        self.end_s = time_s
        if not self.samples or self.samples[-1][0] < time_s:
            self.sampled(time_s)
        for call in self.questions:  # answers that take effect after the end count as well
            if call.completed_us < 0:
                self.optimiser_answered(call)
        self.energy.ended()
        self.packing.ended(time_s)
        self.pickers.ended(time_s)
        self.motion = self.traffic.motion()
        self.heat = self.traffic.heat()
        self.trips = self.traffic.trips()
        self.edges = self.traffic.edges()
        self.plans = self.traffic.plans()
        self.counters = self.traffic.counters()
        number_of, seconds = self._disturbances.within(self.start_s, time_s)
        self.counters |= {"disturbances": number_of, "disturbed_s": seconds}
        for name, number in self._order_counts().items():
            self.counters[name] = number - self._before[name]
        for station, (since, pod, robot) in self._at_station.items():
            self.visits.add(station, pod, robot, since, nan)
        for (station, _), since in self._in_slot.items():
            self.slots.add(station, since, nan)

    def _order_counts(self) -> dict[str, int]:
        """Return the world's counts of orders since the start of the run."""
        world = self.world
        return {"order_redraws": world.order_redraws, "orders_short": world.orders_short}

    def sampled(self, time_s: float) -> None:
        """Record the fleet's distances, times in each state, and energy up to now."""
        totals = {name: float(values.sum()) for name, values in self.traffic.motion().items()}
        self.samples.append((time_s, totals))
        self.energy.sampled()

    def order_created(self, order: Order) -> None:
        """Track the order."""
        self.open_orders[order.index] = order

    def order_assigned(self, order: Order) -> None:
        """Store the times at which the order, or part of it, and each of its lines are assigned."""
        # the time of the order itself is that of its first part, and lines may join a part later
        now_s = self.world.now_s
        self._in_slot.setdefault((order.station, order.index), now_s)
        for line in order.lines:
            self._line_assigned.setdefault((order.index, line.sku), now_s)

    def slot_freed(self, order: Order) -> None:
        """Record the period in which the order, or a part of it, was assigned to its station."""
        since = self._in_slot.pop((order.station, order.index))
        self.slots.add(order.station, since, self.world.now_s)

    def order_cancelled(self, order: Order) -> None:
        """Record the order and stop tracking it."""
        self.order_completed(order)

    def order_completed(self, order: Order) -> None:
        """Record the order and stop tracking it."""
        self.orders.add(*order_row(order))
        del self.open_orders[order.index]

    def tote_held(self, station: int, from_s: float, to_s: float) -> None:
        """Record the period in which a tote could not leave its station."""
        self.packing.held.add(station, from_s, to_s)

    def order_packed(self, parcel: Parcel) -> None:
        """Record the parcel."""
        self.packing.packed(parcel)

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
        """Record the unit."""
        self._picked_by = robot
        self.units.add(time_s, order.index, sku, pod, robot, station, late_bound)
        self.energy.picked(order.index, station)

    def unit_handled(self, handled: Handled) -> None:
        """Record how the unit was handled."""
        self.pickers.handled(handled)

    def picker_left(self, picker: int, station: int, from_s: float, to_s: float) -> None:
        """Record the period in which a picker was at a station."""
        self.pickers.presence.add(picker, station, from_s, to_s)

    def line_picked(self, time_s: float, order: Order, sku: int, units: int) -> None:
        """Record the line."""
        station = order.station
        handled_s = self._busy_until.get(station, time_s)
        assigned_s = self._line_assigned.pop((order.index, sku))
        whole = (order.index, self._picked_by, assigned_s, handled_s)
        self.lines.add(time_s, sku, station, *whole)

    def bundle_created(self, bundle: Bundle) -> None:
        """Track the bundle."""
        self.open_bundles[bundle.index] = bundle

    def bundle_stored(self, bundle: Bundle, robot: int) -> None:
        """Record the bundle and stop tracking it."""
        self.bundles.add(*bundle_row(bundle), robot)
        del self.open_bundles[bundle.index]

    def visit_started(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """Remember the start of the visit until it ends."""
        self._at_station[station] = (time_s, pod, robot)

    def visit_ended(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """Record the visit."""
        since = self._at_station.pop(station)[0]
        self.visits.add(station, pod, robot, since, time_s)
        self.energy.left(station, robot)

    def station_busy(self, station: int, from_s: float, to_s: float) -> None:
        """Record the period in which a station is busy."""
        self.busy.add(station, from_s, to_s)
        self._busy_until[station] = to_s

    def task_started(self, time_s: float, robot: int, kind: str, station: int) -> None:
        """Record the task."""
        self.tasks.add(time_s, robot, self._task_number[kind])

    def pod_lifted(self, time_s: float, pod: int, robot: int, waypoint: int) -> None:
        """Record the lift."""
        self.lifts.add(time_s, pod, robot)

    def decision(self, problem: str, time_s: float, wall_s: float, decisions: int) -> None:
        """Count a controller's call, add its wall time, and record the call if `decisions` > 0."""
        try:
            asked = self.asked[problem]
        except KeyError:
            asked = self.asked[problem] = [0, 0.0]
        asked[0] += 1
        asked[1] += wall_s
        if decisions:
            if problem not in self.problems:
                self.problems.append(problem)
            self.calls.add(time_s, self.problems.index(problem), decisions, wall_s)

    def rule_decided(self, problem: str, time_s: float) -> None:
        """Count a decision that a controller with an optimiser made by its own rule."""
        self.by_rule[problem] = self.by_rule.get(problem, 0) + 1

    def optimiser_asked(self, call: Call) -> None:
        """Record the question."""
        self.questions.append(call)

    def optimiser_answered(self, call: Call) -> None:
        """Record the solution, if there is one.

        The object `call` counts how many of the proposed decisions are applied.
        """
        if call.solution is not None:
            self.solutions[call.number] = to_text(call.solution)

    def station_activated(self, time_s: float, station: int, active: bool) -> None:
        """Record that a station was switched on or off."""
        self.switches.add(time_s, station, active)


def order_row(order: Order) -> tuple[Any, ...]:
    """Return the row of an order in `Recorder.orders`."""
    return (
        order.index,
        order.station,
        len(order.all_lines),
        sum(line.units for line in order.all_lines) + order.units_cut,
        order.in_file,
        order.priority,
        order.created_s,
        order.due_s,
        order.assigned_s,
        order.completed_s,
        order.cancelled_s,
        order.units_cut,
    )


def bundle_row(bundle: Bundle) -> tuple[Any, ...]:
    """Return the row of a bundle in `Recorder.bundles`, without the robot."""
    return (
        bundle.stored_s,
        bundle.created_s,
        bundle.assigned_s,
        bundle.sku,
        bundle.units,
        bundle.space,
        bundle.pod,
        bundle.station,
        bundle.in_file,
    )
