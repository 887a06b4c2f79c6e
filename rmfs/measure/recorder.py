"""The observer that writes down what happens in a run.

It only appends to lists while the run goes on; the tables are made afterwards (`tables`). What
happened before the end of the warm-up stays in the lists, because work in progress carries over;
the tables leave it out.
"""

from __future__ import annotations

from array import array
from math import nan
from typing import TYPE_CHECKING

from rmfs.control.solutions import to_text
from rmfs.measure.observer import Observer

if TYPE_CHECKING:
    from typing import Any

    from numpy.typing import NDArray

    from rmfs.control.asks import Call
    from rmfs.layout.model import Layout
    from rmfs.simulation.simulation import Simulation
    from rmfs.world.orders import Bundle, Order
    from rmfs.world.world import World


class Calls:
    """Calls of controllers that came to a decision, column by column: a long run has millions.

    Attributes
    ----------
    number
        A number for each problem, in the order in which they first occurred.
    time_s, problem, decisions, wall_s
        One entry per call; `problem` holds the problem's number.
    """

    def __init__(self) -> None:
        self.number: dict[str, int] = {}
        self.time_s = array("d")
        self.problem = array("b")
        self.decisions = array("i")
        self.wall_s = array("d")

    def add(self, problem: str, time_s: float, wall_s: float, decisions: int) -> None:
        """Write a call down."""
        self.time_s.append(time_s)
        self.problem.append(self.number.setdefault(problem, len(self.number)))
        self.decisions.append(decisions)
        self.wall_s.append(wall_s)


class Recorder(Observer):
    """Everything a run's tables are made from.

    Attributes
    ----------
    start_s, end_s
        The measured time.
    units
        Picked units: time, order, sku, pod, robot, station, late bound.
    lines
        Finished lines: time, sku, station.
    finished_orders
        Completed orders, one row each as in `order_row`.
    open_orders
        Orders not yet completed, by index.
    stored_bundles
        Stored bundles: time, created, assigned, sku, units, space, pod, station, robot.
    open_bundles
        Bundles not yet stored, by index.
    visits
        Pods at stations: station, pod, robot, begin, end.
    busy
        Stations at work: station, begin, end.
    tasks
        Tasks started: time, robot, kind.
    lifts
        Pods lifted: time, pod, robot.
    calls
        Controllers asked that came to a decision.
    asked
        Per problem, number and wall time of all calls since the warm-up.
    questions
        Calls of optimisers, in the order in which they were asked.
    solutions
        Their solutions as text, by number.
    by_rule
        Per problem whose controller asks optimisers, its decisions without one since the warm-up.
    activations
        Stations switched: time, station, active.
    samples
        Every minute: time, and the fleet's totals of distance and times since the last reset.
    """

    def __init__(self) -> None:
        self.layout: Layout
        self.world: World
        self.start_s = 0.0
        self.end_s = nan
        self.units: list[tuple[float, int, int, int, int, int, bool]] = []
        self.lines: list[tuple[float, int, int]] = []
        self.finished_orders: list[tuple[Any, ...]] = []
        self.open_orders: dict[int, Order] = {}
        self.stored_bundles: list[tuple[Any, ...]] = []
        self.open_bundles: dict[int, Bundle] = {}
        self.visits: list[tuple[int, int, int, float, float]] = []
        self.busy: list[tuple[int, float, float]] = []
        self.tasks: list[tuple[float, int, str]] = []
        self.lifts: list[tuple[float, int, int]] = []
        self.calls = Calls()
        self.asked: dict[str, list[float]] = {}
        self.questions: list[Call] = []
        self.solutions: dict[int, str] = {}
        self.by_rule: dict[str, int] = {}
        self.activations: list[tuple[float, int, bool]] = []
        self.samples: list[tuple[float, dict[str, float]]] = []
        self.stored_space_start = 0.0
        self.motion: dict[str, NDArray[Any]] = {}
        self.heat: dict[str, NDArray[Any]] = {}
        self.trips: dict[str, NDArray[Any]] = {}
        self.edges: dict[str, NDArray[Any]] = {}
        self.counters: dict[str, float] = {}
        self._at_station: dict[int, tuple[float, int, int]] = {}
        self._redraws_before = 0

    @property
    def duration_s(self) -> float:
        """Length of the measured time."""
        return self.end_s - self.start_s

    def run_started(self, simulation: Simulation) -> None:
        """Keep hold of the world and the traffic."""
        self.layout, self.world = simulation.layout, simulation.world
        self._traffic = simulation.traffic
        self.stored_space_start = simulation.world.inventory.stored_space

    def warmup_ended(self, time_s: float) -> None:
        """Begin to measure."""
        self.start_s = time_s
        self.asked.clear()
        self.by_rule.clear()
        self._redraws_before = self.world.order_redraws

    def run_ended(self, time_s: float) -> None:
        """Take what traffic has counted, and close what is still open."""
        self.end_s = time_s
        if not self.samples or self.samples[-1][0] < time_s:
            self.sampled(time_s)
        self.motion = self._traffic.motion()
        self.heat = self._traffic.heat()
        self.trips = self._traffic.trips()
        self.edges = self._traffic.edges()
        self.counters = self._traffic.counters()
        self.counters["order_redraws"] = self.world.order_redraws - self._redraws_before
        for station, (since, pod, robot) in self._at_station.items():
            self.visits.append((station, pod, robot, since, nan))

    def sampled(self, time_s: float) -> None:
        """Add up the robots' motion."""
        totals = {name: float(values.sum()) for name, values in self._traffic.motion().items()}
        self.samples.append((time_s, totals))

    def order_created(self, order: Order) -> None:
        """Follow the order."""
        self.open_orders[order.index] = order

    def order_completed(self, order: Order) -> None:
        """Write the order down and let it go."""
        self.finished_orders.append(order_row(order))
        del self.open_orders[order.index]

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
        """Write the unit down."""
        self.units.append((time_s, order.index, sku, pod, robot, station, late_bound))

    def line_picked(self, time_s: float, order: Order, sku: int, units: int) -> None:
        """Write the line down."""
        self.lines.append((time_s, sku, order.station))

    def bundle_created(self, bundle: Bundle) -> None:
        """Follow the bundle."""
        self.open_bundles[bundle.index] = bundle

    def bundle_stored(self, bundle: Bundle, robot: int) -> None:
        """Write the bundle down and let it go."""
        self.stored_bundles.append((*bundle_row(bundle), robot))
        del self.open_bundles[bundle.index]

    def visit_started(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """A pod is at the station."""
        self._at_station[station] = (time_s, pod, robot)

    def visit_ended(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """Write the visit down."""
        since = self._at_station.pop(station)[0]
        self.visits.append((station, pod, robot, since, time_s))

    def station_busy(self, station: int, from_s: float, to_s: float) -> None:
        """Write the work down."""
        self.busy.append((station, from_s, to_s))

    def task_started(self, time_s: float, robot: int, kind: str, station: int) -> None:
        """Write the task down."""
        self.tasks.append((time_s, robot, kind))

    def pod_lifted(self, time_s: float, pod: int, robot: int, waypoint: int) -> None:
        """Write the lift down."""
        self.lifts.append((time_s, pod, robot))

    def decision(self, problem: str, time_s: float, wall_s: float, decisions: int) -> None:
        """Write the call down."""
        try:
            asked = self.asked[problem]
        except KeyError:
            asked = self.asked[problem] = [0, 0.0]
        asked[0] += 1
        asked[1] += wall_s
        if decisions:
            self.calls.add(problem, time_s, wall_s, decisions)

    def rule_decided(self, problem: str, time_s: float) -> None:
        """Count the decision."""
        self.by_rule[problem] = self.by_rule.get(problem, 0) + 1

    def optimiser_asked(self, call: Call) -> None:
        """Follow the call."""
        self.questions.append(call)

    def optimiser_answered(self, call: Call) -> None:
        """Write the solution down; what it is used for, the call counts."""
        if call.solution is not None:
            self.solutions[call.number] = to_text(call.solution)

    def station_activated(self, time_s: float, station: int, active: bool) -> None:
        """Write the switch down."""
        self.activations.append((time_s, station, active))


def order_row(order: Order) -> tuple[Any, ...]:
    """Return what the tables need of an order: the first columns of the table `orders`."""
    return (
        order.index,
        order.station,
        len(order.all_lines),
        sum(line.units for line in order.all_lines),
        order.created_s,
        order.due_s,
        order.assigned_s,
        order.completed_s,
    )


def bundle_row(bundle: Bundle) -> tuple[Any, ...]:
    """Return what the tables need of a bundle."""
    return (
        bundle.stored_s,
        bundle.created_s,
        bundle.assigned_s,
        bundle.sku,
        bundle.units,
        bundle.space,
        bundle.pod,
        bundle.station,
    )
