"""The kernel: world, fleet, controllers and agenda of one run, put together."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

from rmfs.control.problems import Trigger
from rmfs.control.travel import Travel
from rmfs.control.view import View
from rmfs.errors import InputError
from rmfs.observer import Observed, Observer
from rmfs.scenario import bundles_to_cover, initial_stock, sku_set
from rmfs.simulation.advice import Advice
from rmfs.simulation.agenda import Agenda
from rmfs.simulation.alarms import Alarms
from rmfs.simulation.applying import Applying
from rmfs.simulation.arrivals import ArrivalProcess
from rmfs.simulation.charging.chargers import Chargers
from rmfs.simulation.charging.guard import EnergyGuard
from rmfs.simulation.charging.setup import count_energy
from rmfs.simulation.controller_set import ControllerSet
from rmfs.simulation.deciding import Deciding
from rmfs.simulation.dispatch import Dispatch
from rmfs.simulation.disturbances import DisturbanceSource
from rmfs.simulation.events import Events
from rmfs.simulation.forking import Snapshot
from rmfs.simulation.late_binding import LateBinding
from rmfs.simulation.lookahead import Forks
from rmfs.simulation.loop import Loop
from rmfs.simulation.optimisers import OptimiserGateway
from rmfs.simulation.outside import Outside, problems_outside
from rmfs.simulation.pacing import InstantPacing, pacing_of
from rmfs.simulation.packing.stage import packing_stage
from rmfs.simulation.past import PastOrders
from rmfs.simulation.phase import DecisionPhase
from rmfs.simulation.pickers.setup import staffed
from rmfs.simulation.service import services_of
from rmfs.simulation.shortage import short_orders
from rmfs.simulation.steps import Due
from rmfs.simulation.triggers import Triggers
from rmfs.simulation.visits import Visits
from rmfs.traffic import Traffic
from rmfs.world import World

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rmfs.control.base import Controller
    from rmfs.control.choices import Choice
    from rmfs.control.problems import Problem
    from rmfs.control.settings import ControllerSettings
    from rmfs.layout.model import Layout
    from rmfs.scenario import Scenario, StreamRecorder
    from rmfs.simulation.pacing import Paced


class Kernel(Loop):
    """One run, put together from its parts; the base class `Loop` drives it.

    Parameters
    ----------
    layout, scenario, controllers
        The inputs of the simulation.
    seed
        Seed of all random streams, 0 or greater.
    observers
        Notified of everything that happens.
    outside
        Decision problems that are decided outside the simulation, such as `["poa", "pps"]`; `step`
        returns each decision to be made. The controllers of these problems stay installed: they
        determine when decisions are due, and can give advice.
    pacing
        How simulated time accounts for the computation of optimisers.
    traffic
        Model of the robots' motion. Default: a `Traffic` object that records no trace.
    streams
        Records all orders and bundles that arrive, so that they can be written to files and used
        in other runs.

    Attributes
    ----------
    world, view
        The state of the warehouse, and the read-only view of it that controllers get.
    interventions
        One pair per call of `exchange`: the time of the call in s, and the new controller.

    Raises
    ------
    InputError
        If a problem cannot be decided outside the simulation.
    """

    def __init__(
        self,
        layout: Layout,
        scenario: Scenario,
        controllers: ControllerSettings,
        *,
        seed: int = 0,
        observers: Sequence[Observer] = (),
        outside: Iterable[str] = (),
        pacing: Paced | None = None,
        traffic: Traffic | None = None,
        streams: StreamRecorder | None = None,
    ) -> None:
        self.layout = layout
        self.scenario = scenario
        self.controllers = controllers
        self.seed = seed
        self.warmup_s = scenario.warmup_s
        self.end_s = scenario.warmup_s + scenario.duration_s
        self.pacing: Paced = pacing or InstantPacing()
        self.interventions: list[tuple[float, Choice]] = []
        self.traffic = fleet = traffic if traffic is not None else Traffic(layout)
        self.agenda = agenda = Agenda()
        self.world = world = _stocked_world(layout, scenario, seed)
        self.events = events = Events()
        masses = count_energy(scenario.energy, layout, world, fleet, seed)
        past = PastOrders(scenario, world.skus, seed)
        travel = Travel(layout, fleet)
        self.view = View(world, travel, self.end_s, past, scenario.time_of_day_s)
        self.controller_set = installed = ControllerSet(
            controllers, self.view, seed, Forks(self._snapshot)
        )
        services = services_of(layout, agenda=agenda, world=world, events=events)
        packing = packing_stage(
            scenario.packing, layout, services, seed, agenda=agenda, world=world, events=events
        )
        people, self._roster = staffed(
            scenario.pickers,
            layout,
            services,
            seed,
            scenario.time_of_day_s,
            agenda=agenda,
            world=world,
            events=events,
        )
        self.dispatch = Dispatch(layout, world, fleet, events, installed, services)
        self.chargers = Chargers(layout, services, fleet)
        visits = Visits(world, self.view, self.dispatch, seed)
        late_binding = LateBinding(world, travel, installed, events)
        due = Due(world, installed)
        self.guard: EnergyGuard | None = None
        if scenario.energy is not None and world.batteries is not None:
            self.guard = EnergyGuard(
                scenario.energy,
                world.batteries,
                self.view,
                agenda=agenda,
                dispatch=self.dispatch,
                fleet=fleet,
                controllers=installed,
                due=due,
            )
        decided_outside = problems_outside(outside, controllers.choices)
        alarms = Alarms(agenda, installed, due.want, decided_outside)
        self.deciding = Deciding(world, events, installed, alarms, controllers.choices)
        self.advice = Advice(world, installed, self.deciding)
        self.phase = DecisionPhase(
            controllers.choices,
            Outside(decided_outside),
            agenda=agenda,
            world=world,
            view=self.view,
            events=events,
            controllers=installed,
            due=due,
            alarms=alarms,
            deciding=self.deciding,
            dispatch=self.dispatch,
            late_binding=late_binding,
            visits=visits,
            guard=self.guard,
        )
        self.applying = Applying(
            world,
            events,
            self.dispatch,
            prepare=self.phase.prepare,
            exchange=self.phase.exchange_controller,
            unplug=self.chargers.unplug,
        )
        self.arrivals = ArrivalProcess(
            layout,
            scenario,
            seed,
            agenda=agenda,
            world=world,
            events=events,
            wanted=due.want_arrivals,
            recorder=streams,
        )
        self.optimisers = OptimiserGateway(
            pacing_of(self.pacing, seed),
            agenda=agenda,
            world=world,
            events=events,
            answers=self.phase,
        )
        self.deciding.connect(self.applying, self.optimisers)
        self.phase.connect(self.applying, self.arrivals)
        self.disturbances = DisturbanceSource(
            layout, scenario.disturbances, seed, agenda=agenda, fleet=fleet, chargers=self.chargers
        )
        self._spectators = tuple(observers)
        inside = [*masses, *packing, *people, late_binding, *visits.controllers]
        inside += short_orders(
            scenario.orders.shortage,
            agenda=agenda,
            world=world,
            events=events,
            changed=due.want_arrivals,
        )
        events.tell([*inside, *observers, Triggers(due)])
        self._due = due
        super().__init__(self.dispatch)

    def _begin(self) -> None:
        choices = self.controllers.choices.values()
        self.optimisers.begin(m for choice in choices for m in choice.controller.optimisers)
        self.events.run_started(self.observed())
        self.disturbances.begin()
        if self._roster is not None:
            self._roster.begin()
        if self.guard is not None:
            self.guard.begin()
        self.arrivals.top_up()
        self._due.signal(Trigger.START)

    def _end(self) -> None:
        self.chargers.run_ended()
        super()._end()

    def exchange(self, choice: Choice) -> None:
        """Install, at this instant, a controller chosen by a user, and record the exchange."""
        self.interventions.append((self.world.now_s, choice))
        self.phase.exchange(choice)

    # --- looking ahead --------------------------------------------------------------------------

    def _snapshot(self, along: Any) -> Snapshot[Self]:
        """Save the state of the run, together with `along` but without passive observers."""
        return Snapshot(self, along, self._spectators)

    def take_over(
        self, problem: Problem, base: Controller[Any], decision: Any, watch: Observer
    ) -> None:
        """Apply a decision on a problem; from then on, the controller `base` decides the problem.

        This method is called in copies of a run, to try out decisions.

        Parameters
        ----------
        watch
            Observer that is notified of what happens from now on.
        """
        *inside, triggers = self.events.observers
        kept = [one for one in inside if type(one) is not Observer]
        self.events.tell([*kept, watch, triggers])
        self.phase.take_over(problem, base)
        self.applying(decision, None)
        self._unsettled = True

    def redraw(self) -> None:
        """Draw future arrivals and disturbances anew.

        This method is called in a copy of a run, after all random streams have been replaced.

        Raises
        ------
        InputError
            If arrivals cannot be drawn, because they are read from a file.
        """
        self.arrivals.redraw()
        self.disturbances.redraw()

    def observed(self) -> Observed:
        """Return the parts of the run that observers may see."""
        return Observed(
            self.layout,
            self.scenario,
            self.world,
            self.traffic,
            self.disturbances,
            self.arrivals.order_stream,
            self.arrivals.bundle_stream,
        )

    def __getstate__(self) -> dict[str, Any]:
        """Return the state, unless a solver process may be running."""
        if self.optimisers.waits:
            raise InputError("a run with pacing wall cannot be copied: a solver may be running")
        return vars(self).copy()


def _stocked_world(layout: Layout, scenario: Scenario, seed: int) -> World:
    """Build the world at time zero."""
    skus = sku_set(scenario.skus)
    world = World(layout, skus)
    needed = bundles_to_cover(scenario, skus)
    share = scenario.stock.initial_share
    stock = initial_stock(skus, layout.pod_capacity, share, seed, first=needed)
    world.stock(stock.pod.tolist(), stock.sku.tolist(), stock.units.tolist())
    return world
