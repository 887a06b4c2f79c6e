"""Observers of a run: the only interface through which the simulation reports events.

The simulation calls the methods of `Observer` as events happen; by default, they do nothing. A
measure overrides the methods that it needs, so the simulation never depends on what is measured.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from rmfs.control.travel import TravelTimes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.asks import Call
    from rmfs.layout.model import Layout
    from rmfs.scenario import Scenario
    from rmfs.scenario.streams import BundleStream, OrderStream
    from rmfs.world import World
    from rmfs.world.orders import Bundle, Order
    from rmfs.world.pickers import Handled
    from rmfs.world.put_wall import Parcel


class MotionCounts(TravelTimes, Protocol):
    """The part of the traffic model that counts motion.

    Unless stated otherwise, counts start at time zero and are reset at the end of the warm-up.
    """

    def motion(self) -> dict[str, NDArray[Any]]:
        """Return distances (m) and times (s) as arrays by name, with one value per robot."""
        ...

    def trips(self) -> dict[str, NDArray[Any]]:
        """Return the completed trips as columns by name."""
        ...

    def edges(self) -> dict[str, NDArray[Any]]:
        """Return each used edge and how many times robots passed it, as columns by name."""
        ...

    def energy(self) -> dict[str, NDArray[Any]]:
        """Return energies (J) and charging times (s) as arrays by name, with one value per robot.

        The arrays `initial_j`, `ever_charged_j`, `ever_used_j` and `level_j` are not reset. This
        method may be called only if the scenario models energy.
        """
        ...

    def used_j(self, robot: int) -> float:
        """Return the energy drawn by a robot since time zero, less recovered braking energy, in J.

        This method may be called only if the scenario models energy.
        """
        ...

    def plans(self) -> dict[str, NDArray[Any]]:
        """Return the searches for routes since time zero, as columns by name, one row per search.

        The columns are empty if searches take no simulated time.
        """
        ...

    def counters(self) -> dict[str, float]:
        """Return counts and times (s) of path planning, by name."""
        ...


class Troubles(Protocol):
    """The part of a run that records disturbances."""

    def within(self, start_s: float, end_s: float) -> tuple[int, float]:
        """Return how many disturbances overlap a period, and their total time in this period (s).

        The times of simultaneous disturbances are added up.
        """
        ...


@dataclass(frozen=True, slots=True)
class Observed:
    """The state of a run, which observers may read but must not change.

    Attributes
    ----------
    layout, scenario
        The layout and the scenario that are simulated.
    world
        Pods, orders, stations and robots in their current state; `world.now_s` is the current time.
    traffic
        Counts of motion, and travel times.
    disturbances
        Record of the disturbances in the run.
    order_stream, bundle_stream
        The orders and the bundles if they are read from files; None otherwise.
    """

    layout: Layout
    scenario: Scenario
    world: World
    traffic: MotionCounts
    disturbances: Troubles
    order_stream: OrderStream | None
    bundle_stream: BundleStream | None


class Observer:
    """Callbacks of a run; by default, each of them does nothing.

    Times are simulated seconds. Orders and bundles are given as objects; robots, pods, stations,
    SKUs and waypoints by index.
    """

    def run_started(self, run: Observed) -> None:
        """Report that the world is built and stocked; nothing has happened yet."""

    def run_ended(self, time_s: float) -> None:
        """Report the end of the run, after which the state of the world no longer changes."""

    def order_created(self, order: Order) -> None:
        """Report that a pick order joined the backlog (`order.created_s`)."""

    def order_cut(self, order: Order) -> None:
        """Report that units not in stock were cut from a backlog order (`order.units_cut`)."""

    def order_cancelled(self, order: Order) -> None:
        """Report that an order was cancelled for lack of stock (`order.cancelled_s`)."""

    def order_assigned(self, order: Order) -> None:
        """Report that POA assigned an order, or a part of one, to a pick station.

        The station and the time are `order.station` and `order.assigned_s`.
        """

    def order_queued(self, order: Order) -> None:
        """Report that an order of the backlog was reserved for a station (`order.queued_at`).

        Such an order is in the station's pool: it has no slot yet.
        """

    def pool_changed(self, station: int) -> None:
        """Report that other pods than before may be useful for the pool of a pick station.

        The reason is that the station has a free slot again, or that only some of the open units of
        an order in the pool were bound to a pod.
        """

    def picks_changed(self, time_s: float, robot: int) -> None:
        """Report that requests were bound to the pod of a robot's pick task, or released from it.

        This method may also be called when nothing has changed.
        """

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
        """Report that the pick of a unit starts.

        `late_bound` is true if the unit was bound to the pod after the robot's task had begun.
        """

    def unit_handled(self, handled: Handled) -> None:
        """Report how a picker handles the unit that was just reported by `unit_picked`.

        This method is called only in scenarios with pickers.
        """

    def picker_left(self, picker: int, station: int, from_s: float, to_s: float) -> None:
        """Report that a picker, present at a pick station during [from_s, to_s), leaves it."""

    def line_picked(self, time_s: float, order: Order, sku: int, units: int) -> None:
        """Report that the pick of an order line's last unit starts.

        `units` is the number of units of the whole line.
        """

    def order_completed(self, order: Order) -> None:
        """Report that all parts of an order have left their stations (`order.completed_s`)."""

    def slot_freed(self, order: Order) -> None:
        """Report that an order, or a part of one, has left its pick station and freed its slot."""

    def tote_held(self, station: int, from_s: float, to_s: float) -> None:
        """Report that a filled tote had to stay at its station during [from_s, to_s).

        There was no room for the tote on the conveyor or in the put wall.
        """

    def order_packed(self, parcel: Parcel) -> None:
        """Report that an order has been packed (`parcel.packed_s`).

        This method is called only in scenarios with packing.
        """

    def bundle_created(self, bundle: Bundle) -> None:
        """Report that a bundle (replenishment order) has arrived (`bundle.created_s`)."""

    def bundle_promised(self, bundle: Bundle) -> None:
        """Report that RPS promised a bundle to a pod, that is, chose its pod (`bundle.pod`).

        ROA and TA may act on this choice only after `bundles_released` has been called for the pod.
        """

    def bundles_released(self, pod: int) -> None:
        """Report that the bundles promised to a pod were released; ROA and TA may now use them."""

    def bundle_sent(self, bundle: Bundle) -> None:
        """Report that ROA chose the station of a bundle (`bundle.station`)."""

    def bundle_assigned(self, bundle: Bundle) -> None:
        """Report that a bundle is assigned, that is, it has been released and has a station.

        `bundle.pod`, `bundle.station` and `bundle.assigned_s` give its pod, its station and the
        time of assignment.
        """

    def bundle_stored(self, bundle: Bundle, robot: int) -> None:
        """Report that the transfer of a bundle into its pod starts (`bundle.stored_s`)."""

    def visit_started(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """Report that a robot reached the head of a station's queue.

        `pod` is -1 if the robot carries none.
        """

    def visit_ended(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """Report that a robot leaves the head of a station's queue.

        `pod` is -1 if the robot carries none.
        """

    def station_busy(self, station: int, from_s: float, to_s: float) -> None:
        """Report that a station is busy during [from_s, to_s).

        In this period, the station handles a unit or a bundle, charges a robot, swaps a battery or,
        if its kind is user-defined, keeps a pod.
        """

    def task_started(self, time_s: float, robot: int, kind: str, station: int) -> None:
        """Report that a robot starts a task.

        `kind` is the `Task.kind` of the task; `station` is -1 if the task leads to no station.
        """

    def robot_free(self, robot: int) -> None:
        """Report that a robot has ended its task and needs a new one."""

    def place_left(self, robot: int) -> None:
        """Report that a robot has left storage locations that were reserved for it until now."""

    def pod_lifted(self, time_s: float, pod: int, robot: int, waypoint: int) -> None:
        """Report that a robot starts to lift a pod."""

    def pod_set_down(self, time_s: float, pod: int, robot: int, waypoint: int) -> None:
        """Report that a robot has set down its pod at a storage location."""

    def decision(self, problem: str, time_s: float, wall_s: float, decisions: int) -> None:
        """Report a call of the controller of `problem` that took `wall_s` seconds of wall time.

        `decisions` is the number of decisions that the controller made without an optimiser.
        Decisions taken from an optimiser's solution are counted in the `Call` of the optimiser.
        """

    def rule_decided(self, problem: str, time_s: float) -> None:
        """Report that a controller with an optimiser made a decision by its own rule instead."""

    def optimiser_asked(self, call: Call) -> None:
        """Report that a controller called an optimiser; `call` contains the question."""

    def optimiser_answered(self, call: Call) -> None:
        """Report that an optimiser answered, or that its call failed or was abandoned.

        Some of the decisions in the answer may be applied later.
        """

    def controller_exchanged(self, time_s: float, problem: str, name: str) -> None:
        """Report that controller `name` has replaced the previous controller for `problem`."""

    def station_activated(self, time_s: float, station: int, active: bool) -> None:
        """Report that SA switched a station on or off."""

    def warmup_ended(self, time_s: float) -> None:
        """Report that the warm-up ends and measuring begins; work in progress continues."""

    def sampled(self, time_s: float) -> None:
        """Report that another minute of the measured time has been simulated."""
