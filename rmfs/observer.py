"""Observers of a run: the only interface through which the kernel reports events.

The simulation calls these methods as events happen; by default each does nothing. A measure
overrides the few it needs, so that the simulation never depends on what is measured.
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
    """The part of the traffic model that counts motion, starting after the warm-up."""

    def motion(self) -> dict[str, NDArray[Any]]:
        """Return distances and times of each robot."""
        ...

    def heat(self) -> dict[str, NDArray[Any]]:
        """Return visits and waiting at each waypoint."""
        ...

    def trips(self) -> dict[str, NDArray[Any]]:
        """Return the completed trips."""
        ...

    def edges(self) -> dict[str, NDArray[Any]]:
        """Return the number of passages of each edge that was used."""
        ...

    def energy(self) -> dict[str, NDArray[Any]]:
        """Return the energy drawn and charged by each robot; only if the scenario models energy."""
        ...

    def used_j(self, robot: int) -> float:
        """Return the energy drawn by a robot since time zero; only with an energy model."""
        ...

    def counters(self) -> dict[str, float]:
        """Return counters of path planning, and its wall time."""
        ...


class Troubles(Protocol):
    """The part of a run that records disturbances."""

    def within(self, start_s: float, end_s: float) -> tuple[int, float]:
        """Return the number of disturbances in a time interval, and their total duration."""
        ...


@dataclass(frozen=True, slots=True)
class Observed:
    """The state of a run as observers see it: to be read, never to be changed.

    Attributes
    ----------
    layout, scenario
        The simulated inputs.
    world
        Pods, orders, stations and robots in their current state; `world.now_s` is the time.
    traffic
        Counts motion and knows travel times.
    disturbances
        Disturbances of the run.
    order_stream, bundle_stream
        The orders and bundles read from a file, if the scenario names one.
    """

    layout: Layout
    scenario: Scenario
    world: World
    traffic: MotionCounts
    disturbances: Troubles
    order_stream: OrderStream | None
    bundle_stream: BundleStream | None


class Observer:
    """Callbacks of a run. Times are simulated seconds; entities are given by their index."""

    def run_started(self, run: Observed) -> None:
        """Report that the world is built and stocked; nothing has happened yet."""

    def run_ended(self, time_s: float) -> None:
        """Report the end of the run; the world stays as it is."""

    def order_created(self, order: Order) -> None:
        """Report that a pick order joined the backlog (`order.created_s`)."""

    def order_cut(self, order: Order) -> None:
        """Report that an order in the backlog lost units that are not in stock (`units_cut`)."""

    def order_cancelled(self, order: Order) -> None:
        """Report that an order that stock cannot serve was cancelled (`order.cancelled_s`)."""

    def order_assigned(self, order: Order) -> None:
        """Report that POA assigned an order to a pick station (`station`, `assigned_s`)."""

    def order_queued(self, order: Order) -> None:
        """Report that an order moved from the backlog to a station's pool (`order.queued_at`)."""

    def picks_changed(self, time_s: float, robot: int) -> None:
        """Report that requests were bound to the pod of a current pick task, or reopened."""

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
        """Report a picked unit; `late_bound`: it was added to the pod's task while under way."""

    def unit_handled(self, handled: Handled) -> None:
        """Report how the picker handled the last unit; only in scenarios with pickers."""

    def picker_left(self, picker: int, station: int, from_s: float, to_s: float) -> None:
        """Report that a picker leaves a pick station, having been there during [from_s, to_s)."""

    def line_picked(self, time_s: float, order: Order, sku: int, units: int) -> None:
        """Report that the last unit of an order line was picked."""

    def order_completed(self, order: Order) -> None:
        """Report that an order is picked and has left its station (`order.completed_s`)."""

    def slot_freed(self, order: Order) -> None:
        """Report that a pick station released an order, or its part of one, and freed the slot."""

    def tote_held(self, station: int, from_s: float, to_s: float) -> None:
        """Report that an order, or a part, could not leave a pick station during [from_s, to_s)."""

    def order_packed(self, parcel: Parcel) -> None:
        """Report that an order is packed (`parcel.packed_s`); only in scenarios with packing."""

    def bundle_created(self, bundle: Bundle) -> None:
        """Report that a replenishment order (bundle) joined the backlog (`bundle.created_s`)."""

    def bundle_promised(self, bundle: Bundle) -> None:
        """Report that RPS chose the pod of a bundle (`bundle.pod`) but has not released it yet."""

    def bundles_released(self, pod: int) -> None:
        """Report that RPS released the bundles promised to a pod."""

    def bundle_sent(self, bundle: Bundle) -> None:
        """Report that ROA chose the station of a bundle (`bundle.station`)."""

    def bundle_assigned(self, bundle: Bundle) -> None:
        """Report that a bundle has a station and a pod (`station`, `pod`, `assigned_s`)."""

    def bundle_stored(self, bundle: Bundle, robot: int) -> None:
        """Report that a bundle was put into its pod (`bundle.stored_s`)."""

    def visit_started(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """Report that a robot with its pod reached the head of a station's queue."""

    def visit_ended(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """Report that the robot was sent away from the station."""

    def station_busy(self, station: int, from_s: float, to_s: float) -> None:
        """Report that the station handles one unit or bundle during [from_s, to_s)."""

    def task_started(self, time_s: float, robot: int, kind: str, station: int) -> None:
        """Report a task from TA: pick, replenish, park, rest or reposition (station or -1)."""

    def robot_free(self, robot: int) -> None:
        """Report that a robot's task ended and it needs a new one."""

    def place_left(self, robot: int) -> None:
        """Report that a robot left storage places that were reserved for it."""

    def pod_lifted(self, time_s: float, pod: int, robot: int, waypoint: int) -> None:
        """Report that a robot starts to lift a pod."""

    def pod_set_down(self, time_s: float, pod: int, robot: int, waypoint: int) -> None:
        """Report that a pod stands at a storage place again."""

    def decision(self, problem: str, time_s: float, wall_s: float, decisions: int) -> None:
        """Report that a controller made this many decisions in one call (POA, PPS, ...)."""

    def rule_decided(self, problem: str, time_s: float) -> None:
        """Report that a controller that uses optimisers decided by its own rule."""

    def optimiser_asked(self, call: Call) -> None:
        """Report that a controller asked an optimiser a question."""

    def optimiser_answered(self, call: Call) -> None:
        """Report that an answer arrived or the call failed; parts of it may be applied later."""

    def controller_exchanged(self, time_s: float, problem: str, name: str) -> None:
        """Report that another controller was installed for a problem."""

    def station_activated(self, time_s: float, station: int, active: bool) -> None:
        """Report that SA switched a station on or off."""

    def warmup_ended(self, time_s: float) -> None:
        """Report the end of the warm-up: forget all counts; work in progress carries over."""

    def sampled(self, time_s: float) -> None:
        """Report that a minute of simulated time has passed."""
