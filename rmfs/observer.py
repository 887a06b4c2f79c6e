"""What a run tells those who observe it: the one way in which the kernel says what happened.

The simulation calls these methods as things happen; each does nothing here. A measure overrides
the few it needs, so that the simulation never asks what is being measured.
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
    """The part of traffic that counts motion, from the end of the warm-up on."""

    def motion(self) -> dict[str, NDArray[Any]]:
        """Distances and times of each robot."""
        ...

    def heat(self) -> dict[str, NDArray[Any]]:
        """Visits and waiting at each waypoint."""
        ...

    def trips(self) -> dict[str, NDArray[Any]]:
        """Trips that ended."""
        ...

    def edges(self) -> dict[str, NDArray[Any]]:
        """Passages of each edge that was used."""
        ...

    def energy(self) -> dict[str, NDArray[Any]]:
        """Energy drawn and charged by each robot; only if the scenario counts it."""
        ...

    def used_j(self, robot: int) -> float:
        """Energy drawn by a robot since time zero; only if the scenario counts it."""
        ...

    def counters(self) -> dict[str, float]:
        """Counts of path planning, and its wall time."""
        ...


class Troubles(Protocol):
    """What knows the disturbances of a run."""

    def within(self, start_s: float, end_s: float) -> tuple[int, float]:
        """Return how many were going on in a stretch of time, and their seconds in it."""
        ...


@dataclass(frozen=True, slots=True)
class Observed:
    """What is to be seen of a run: to be looked at, never to be changed.

    Attributes
    ----------
    layout, scenario
        What is simulated.
    world
        Pods, orders, stations and robots, as they are at any moment; `world.now_s` is the time.
    traffic
        What counts motion and knows travel times.
    disturbances
        What goes wrong.
    order_stream, bundle_stream
        The orders and the bundles of a file, if the scenario names one.
    """

    layout: Layout
    scenario: Scenario
    world: World
    traffic: MotionCounts
    disturbances: Troubles
    order_stream: OrderStream | None
    bundle_stream: BundleStream | None


class Observer:
    """Callbacks of a run; times are simulated seconds, entities are named by their index."""

    def run_started(self, run: Observed) -> None:
        """The world is built and stocked; nothing has happened yet."""

    def run_ended(self, time_s: float) -> None:
        """The last moment of the run; the world stays as it is."""

    def order_created(self, order: Order) -> None:
        """A pick order joined the backlog (`order.created_s`)."""

    def order_cut(self, order: Order) -> None:
        """Stock could not serve an order of the backlog: it lost units (`order.units_cut`)."""

    def order_cancelled(self, order: Order) -> None:
        """Stock could not serve an order, which was given up (`order.cancelled_s`)."""

    def order_assigned(self, order: Order) -> None:
        """POA put the order on a pick station (`order.station`, `order.assigned_s`)."""

    def order_queued(self, order: Order) -> None:
        """An order of the backlog joined the pool of a pick station (`order.queued_at`)."""

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
        """A unit left a pod for an order; `late_bound`: added to the pod's task on its way."""

    def unit_handled(self, handled: Handled) -> None:
        """How the picker handled the unit just picked; only where the scenario has pickers."""

    def picker_left(self, picker: int, station: int, from_s: float, to_s: float) -> None:
        """A picker has been at a pick station during [from_s, to_s) and leaves it."""

    def line_picked(self, time_s: float, order: Order, sku: int, units: int) -> None:
        """The last unit of an order line was picked."""

    def order_completed(self, order: Order) -> None:
        """All units are picked and the station handed the order on (`order.completed_s`)."""

    def slot_freed(self, order: Order) -> None:
        """A pick station handed on an order, or its part of one: the slot is free."""

    def tote_held(self, station: int, from_s: float, to_s: float) -> None:
        """A pick station could not let go an order, or a part of one, during [from_s, to_s)."""

    def order_packed(self, parcel: Parcel) -> None:
        """An order is packed (`parcel.packed_s`); only where the scenario has packing."""

    def bundle_created(self, bundle: Bundle) -> None:
        """A replenishment order (bundle) joined the backlog (`bundle.created_s`)."""

    def bundle_promised(self, bundle: Bundle) -> None:
        """RPS chose the pod of a bundle (`bundle.pod`), without releasing the choice yet."""

    def bundles_released(self, pod: int) -> None:
        """RPS released what was promised to a pod."""

    def bundle_sent(self, bundle: Bundle) -> None:
        """ROA chose the station of a bundle (`bundle.station`)."""

    def bundle_assigned(self, bundle: Bundle) -> None:
        """ROA and RPS are both decided (`bundle.station`, `bundle.pod`, `bundle.assigned_s`)."""

    def bundle_stored(self, bundle: Bundle, robot: int) -> None:
        """The bundle went into its pod (`bundle.stored_s`)."""

    def visit_started(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """A robot with its pod reached the head of a station's queue."""

    def visit_ended(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """The robot was told to leave the station."""

    def station_busy(self, station: int, from_s: float, to_s: float) -> None:
        """The station handles one unit or bundle during [from_s, to_s)."""

    def task_started(self, time_s: float, robot: int, kind: str, station: int) -> None:
        """TA gave the robot a task: pick, replenish, park, rest or reposition (station or -1)."""

    def robot_free(self, robot: int) -> None:
        """A robot's task ended: it needs a new one."""

    def place_left(self, robot: int) -> None:
        """A robot left storage places that were kept for it."""

    def pod_lifted(self, time_s: float, pod: int, robot: int, waypoint: int) -> None:
        """A robot starts to lift a pod."""

    def pod_set_down(self, time_s: float, pod: int, robot: int, waypoint: int) -> None:
        """A pod stands at a storage place again."""

    def decision(self, problem: str, time_s: float, wall_s: float, decisions: int) -> None:
        """A controller was asked (POA, PPS, ...) and gave this many decisions in this wall time."""

    def rule_decided(self, problem: str, time_s: float) -> None:
        """A controller that asks optimisers decided by its own rule."""

    def optimiser_asked(self, call: Call) -> None:
        """A controller handed a question to an optimiser."""

    def optimiser_answered(self, call: Call) -> None:
        """The answer came, or the call failed; what is kept of the solution may be used later."""

    def controller_exchanged(self, time_s: float, problem: str, name: str) -> None:
        """Another controller was installed for a problem."""

    def station_activated(self, time_s: float, station: int, active: bool) -> None:
        """SA switched a station on or off."""

    def warmup_ended(self, time_s: float) -> None:
        """Everything counted so far is to be forgotten; work in progress carries over."""

    def sampled(self, time_s: float) -> None:
        """A minute of simulated time has passed."""
