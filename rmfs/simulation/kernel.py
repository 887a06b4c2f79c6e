"""The kernel: world, fleet, controllers and agenda of one run, and its loop."""

from __future__ import annotations

from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING, Any, Self

from rmfs.control.problems import Trigger
from rmfs.control.travel import Travel
from rmfs.control.view import View
from rmfs.errors import InputError
from rmfs.observer import Observed, Observer
from rmfs.scenario import bundles_to_cover, initial_stock, sku_set
from rmfs.simulation.agenda import LAST, Agenda, us_at
from rmfs.simulation.alarms import Alarms
from rmfs.simulation.applying import Applying
from rmfs.simulation.arrivals import ArrivalProcess
from rmfs.simulation.charging.chargers import Chargers
from rmfs.simulation.charging.guard import EnergyGuard
from rmfs.simulation.charging.setup import count_energy
from rmfs.simulation.controller_set import ControllerSet
from rmfs.simulation.deciding import Deciding
from rmfs.simulation.decision import Decision
from rmfs.simulation.dispatch import Dispatch
from rmfs.simulation.disturbances import DisturbanceSource
from rmfs.simulation.events import Events
from rmfs.simulation.forking import Snapshot
from rmfs.simulation.late_binding import LateBinding
from rmfs.simulation.lookahead import Forks
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
from rmfs.traffic import EventKind, Traffic
from rmfs.world import World

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from rmfs.control.base import Controller
    from rmfs.control.choices import Choice
    from rmfs.control.problems import Problem
    from rmfs.control.settings import ControllerSettings
    from rmfs.layout.model import Layout
    from rmfs.scenario import Scenario, StreamRecorder
    from rmfs.simulation.pacing import Paced

    Limit = Callable[[int], int]
    """Told the present time, says up to which time (us) may be simulated; waits as it likes."""

SAMPLE_S = 60.0
"""Time between two samples."""

STALL_S = 3600.0
"""So long nothing may move while robots wait for a way before a run is given up."""


class StalledError(RuntimeError):
    """Nothing can move any more; the message lists every robot."""


class Kernel:
    """One run, which goes on as far as it is told.

    Events happen at their exact times; all that happens at one instant is handled before the
    controllers are asked. How often a run stops on its way changes nothing.

    Parameters
    ----------
    layout, scenario, controllers
        What is simulated.
    seed
        Seed of all random streams, 0 or greater.
    observers
        Told of everything that happens.
    outside
        Decision problems that `step` hands out, such as `["poa", "pps"]`. The controllers of these
        problems stay installed: they say when they would be asked, and give advice.
    pacing
        What the thinking of optimisers costs in simulated time.
    traffic
        What moves the robots; by default the compiled core without trace.
    streams
        Keeps all orders and bundles that come, so that they can be written and replayed.

    Attributes
    ----------
    world, view
        The warehouse as it is, and as controllers see it.
    agenda
        The present time, and what is to come.
    end_s
        When the run ends.
    interventions
        Controllers exchanged by hand, and when (s).
    wall_s
        Wall time of simulating so far.
    instants
        At how many instants something has happened so far.

    Raises
    ------
    InputError
        If a problem cannot be decided outside.
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
        late_binding = LateBinding(world, travel, installed)
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
        self._end_us = us_at(self.end_s)
        self._moved_us = 0
        self._begun = self._ended = False
        self.wall_s = 0.0
        self.instants = 0
        self._unsettled = self._quiet = False
        self._handlers = _traffic_handlers(self.dispatch)

    @property
    def now_us(self) -> int:
        """Present time in microseconds; `world.now_s` is the same in seconds."""
        return self.agenda.now_us

    @property
    def now_s(self) -> float:
        """Present simulated time."""
        return self.world.now_s

    @property
    def ended(self) -> bool:
        """Whether the run has come to its end."""
        return self._ended

    # --- going on ---------------------------------------------------------------------------------

    def run(self, progress: Callable[[float, float], None] | None = None) -> None:
        """Simulate to the end.

        Parameters
        ----------
        progress
            Called with the simulated time so far and in total, about a hundred times.

        Raises
        ------
        RuntimeError
            If a decision is to be taken outside: `step` hands it out.
        StalledError
            If nothing can move any more (only possible in a layout that is not well-formed).
        OptimiserError
            If an optimiser failed and the pacing is one that repeats.
        ReplayError
            If the run that is replayed was another one.
        """
        self.drive(progress)

    def drive(
        self,
        progress: Callable[[float, float], None] | None = None,
        limit: Limit | None = None,
    ) -> None:
        """Simulate to the end, as `run` does, but never past a limit that may move.

        Parameters
        ----------
        limit
            Asked before every instant: for who watches a run.
        """
        try:
            for percent in range(101 if progress is not None else 0):
                until_us = self._end_us * percent // 100
                self._refuse_pending(self._go_on(until_us, limit))
                assert progress is not None
                progress(self.world.now_s, self.end_s)
            self._refuse_pending(self._go_on(self._end_us, limit))
        finally:
            self.optimisers.end()

    def run_until(self, time_s: float) -> Decision | None:
        """Simulate up to a time, all that happens at that time included.

        Returns
        -------
        The decision to be taken outside that comes first, if there is one before that time.
        """
        return self._go_on(min(us_at(time_s), self._end_us))

    def step(self) -> Decision | None:
        """Simulate up to the next decision that is taken outside.

        Returns
        -------
        The decision, which is to be answered before the next step; until then it is this one that
        is handed out. None if the run has come to its end.
        """
        return self._go_on(self._end_us)

    def _go_on(self, until_us: int, limit: Limit | None = None) -> Decision | None:
        if not self._begun:
            self._begin()
        agenda, end_us = self.agenda, until_us
        if end_us < agenda.now_us:
            return self.decision
        started_s = perf_counter()
        try:
            return self._go_on_until(end_us, limit)
        finally:
            self.wall_s += perf_counter() - started_s

    def _go_on_until(self, end_us: int, limit: Limit | None) -> Decision | None:
        agenda = self.agenda
        limits = [limit] if limit is not None else []
        if self.optimisers.waits:
            limits.insert(0, self.optimisers.limit_us)
        while not self._ended:
            if not self._unsettled:
                allowed_us = end_us
                for one in limits:
                    # an answer that comes while this waits goes into the agenda
                    allowed_us = min(allowed_us, one(agenda.now_us))
                self._move(min(agenda.next_us, allowed_us))
            if not self._settle():
                return self.decision
            if agenda.now_us >= end_us and self._quiet and agenda.next_us > end_us:
                if end_us >= self._end_us:
                    self._end()
                return None
        return None

    def _move(self, until_us: int) -> None:
        """Let the next instant happen, up to a time."""
        self.instants += 1
        events = self.traffic.advance(until_us)
        if events:
            self._set_now(events[0][0])
            self._moved_us = self.agenda.now_us
            for _, kind, robot, value in events:
                handler = self._handlers[kind]
                if handler is not None:
                    handler(robot, value)
        else:
            self._set_now(until_us)
        self._quiet = not events
        self.agenda.run_due()
        self._unsettled = True

    def _settle(self) -> bool:
        """Let all be decided that this instant calls for; false if the outside has to."""
        while self.phase.settle():
            if not self.agenda.run_settled():
                self._unsettled = False
                return True
        return False

    def _refuse_pending(self, decision: Decision | None) -> None:
        if decision is not None:
            raise RuntimeError(
                f"{decision.problem} is decided outside: step() hands its decisions out, "
                "run() cannot take them"
            )

    def _set_now(self, now_us: int) -> None:
        self.agenda.now_us = now_us
        self.world.now_s = now_us / 1e6

    # --- decisions ------------------------------------------------------------------------------

    @property
    def decision(self) -> Decision | None:
        """The decision that waits to be taken outside, if there is one."""
        question = self.phase.outside.pending
        return None if question is None else Decision(question, self)

    def exchange(self, choice: Choice) -> None:
        """Exchange a controller by hand at this instant; the run remembers it."""
        self.interventions.append((self.world.now_s, choice))
        self.phase.exchange(choice)

    # --- looking ahead --------------------------------------------------------------------------

    def _snapshot(self, along: Any) -> Snapshot[Self]:
        """Keep the run as it is, without those who only look on."""
        return Snapshot(self, along, self._spectators)

    def take_over(
        self, problem: Problem, base: Controller[Any], decision: Any, watch: Observer
    ) -> None:
        """Take a decision, and let another controller go on from there: in a copy, to try it.

        Parameters
        ----------
        watch
            Observes what comes of it.
        """
        *inside, triggers = self.events.observers
        kept = [one for one in inside if type(one) is not Observer]
        self.events.tell([*kept, watch, triggers])
        self.phase.take_over(problem, base)
        self.applying(decision, None)
        self._unsettled = True

    def redraw(self) -> None:
        """Draw again what is to come and is known already: after all streams have been renewed.

        Raises
        ------
        InputError
            If what comes stands in a file.
        """
        self.arrivals.redraw()
        self.disturbances.redraw()

    def observed(self) -> Observed:
        """What is to be seen of the run."""
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
        """Return everything, unless a solver is at work elsewhere."""
        if self.optimisers.waits:
            raise InputError("a run with pacing wall cannot be copied: a solver may be at work")
        return vars(self).copy()

    # --- what happens at fixed times --------------------------------------------------------------

    def _begin(self) -> None:
        self._begun = True
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
        if self.warmup_s == 0:
            self._end_warmup()
        else:
            self.agenda.at(us_at(self.warmup_s), self._end_warmup, LAST)
        self._unsettled = True

    def _end(self) -> None:
        self._ended = True
        self.optimisers.end()
        self.events.run_ended(self.end_s)

    def _end_warmup(self) -> None:
        self.events.warmup_ended(self.world.now_s)
        self.traffic.reset_statistics()
        for statistics in self.deciding.statistics.values():
            statistics.reset()
        self._sample_again(1)

    def _sample_again(self, number: int) -> None:
        """Take the next sample, counted from the end of the warm-up, if it is within the run."""
        time_s = self.warmup_s + number * SAMPLE_S
        if time_s <= self.end_s:
            self.agenda.at(us_at(time_s), partial(self._sample, number), LAST)

    def _sample(self, number: int) -> None:
        if self.now_us - self._moved_us > STALL_S * 1e6 and self.traffic.blocked():
            raise StalledError(
                f"nothing has moved since {self._moved_us / 1e6:.0f} s\n"
                f"{self.traffic.state_report()}"
            )
        self.traffic.motion()  # robots forget the moves they have made
        self.events.sampled(self.world.now_s)
        self._sample_again(number + 1)


def _traffic_handlers(dispatch: Dispatch) -> list[Callable[[int, int], None] | None]:
    """Handler per kind of event; the others matter only to traffic itself."""
    handlers: list[Callable[[int, int], None] | None] = [None] * len(EventKind)
    handlers[EventKind.DEPARTED] = dispatch.departed
    handlers[EventKind.ARRIVED] = dispatch.departed
    handlers[EventKind.LIFT_STARTED] = dispatch.lift_started
    handlers[EventKind.AT_HEAD] = dispatch.at_head
    handlers[EventKind.SET_DOWN] = dispatch.set_down
    handlers[EventKind.IDLE] = dispatch.idle
    return handlers


def _stocked_world(layout: Layout, scenario: Scenario, seed: int) -> World:
    """Build the world at time zero."""
    skus = sku_set(scenario.skus)
    world = World(layout, skus)
    needed = bundles_to_cover(scenario, skus)
    share = scenario.stock.initial_share
    stock = initial_stock(skus, layout.pod_capacity, share, seed, first=needed)
    world.stock(stock.pod.tolist(), stock.sku.tolist(), stock.units.tolist())
    return world
