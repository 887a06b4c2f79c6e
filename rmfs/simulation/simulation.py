"""The simulation: world, traffic, controllers and agenda of one run, and its loop."""

from __future__ import annotations

from math import ceil
from typing import TYPE_CHECKING

from rmfs.control.problems import Trigger
from rmfs.control.travel import Travel
from rmfs.control.view import View
from rmfs.observer import Observed
from rmfs.scenario import initial_stock, sku_set
from rmfs.simulation.agenda import Agenda
from rmfs.simulation.dispatch import Dispatch
from rmfs.simulation.disturbances import DisturbanceSource
from rmfs.simulation.late_binding import LateBinding
from rmfs.simulation.observers import Observers
from rmfs.simulation.pacing import InstantPacing, pacing_of
from rmfs.simulation.panel import Panel
from rmfs.simulation.past import past_orders
from rmfs.simulation.phase import DecisionPhase
from rmfs.simulation.service import PickService, ReplenishmentService
from rmfs.simulation.supply import Supply
from rmfs.simulation.thinking import Thinking
from rmfs.traffic import EventKind, Traffic
from rmfs.world import World

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rmfs.control.choices import Choice
    from rmfs.control.settings import ControllerSettings
    from rmfs.layout.model import Layout
    from rmfs.observer import Observer
    from rmfs.scenario import Scenario, StreamRecorder
    from rmfs.simulation.pacing import Paced

SAMPLE_S = 60.0
"""Time between two samples."""

STALL_S = 3600.0
"""So long nothing may move while robots wait for a way before a run is given up."""

_LAST = 9  # priority of what only looks: after all that happens at the same time


class StalledError(RuntimeError):
    """Nothing can move any more; the message lists every robot."""


class Simulation:
    """One run, from its first event to its last.

    Events happen at their exact times; all that happens at one instant is handled before the
    controllers are asked.

    Parameters
    ----------
    layout, scenario, controllers
        What is simulated.
    seed
        Seed of all random streams, 0 or greater.
    observers
        Told of everything that happens.
    pacing
        What the thinking of optimisers costs in simulated time.
    traffic
        What moves the robots; by default the compiled core without trace.
    streams
        Keeps all orders and bundles that come, so that they can be written and replayed.

    Attributes
    ----------
    now_us
        Present time in microseconds; `world.now_s` is the same in seconds.
    brakes
        Functions of the present time that say up to which time may be simulated now, and wait as
        long as they like: for who watches a run. How often a run stops on its way changes nothing.
        Replaced as a whole, also by other threads while the run goes on.
    interventions
        Controllers exchanged by hand, and when (s).
    """

    def __init__(
        self,
        layout: Layout,
        scenario: Scenario,
        controllers: ControllerSettings,
        *,
        seed: int = 0,
        observers: Sequence[Observer] = (),
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
        self.now_us = 0
        self.agenda = Agenda()
        self.observers = Observers(observers)
        self.brakes: tuple[Callable[[int], int], ...] = ()
        self.interventions: list[tuple[float, Choice]] = []
        self.traffic = traffic if traffic is not None else Traffic(layout)
        self.world = _stocked_world(layout, scenario, seed)
        travel = Travel(layout, self.traffic)
        self.view = View(
            self.world,
            travel,
            self.end_s,
            lambda: past_orders(scenario, self.world.skus, seed),
            scenario.time_of_day_s,
        )
        self.panel = Panel(controllers, self.view, seed)
        self.dispatch = Dispatch(self)
        self.phase = DecisionPhase(self, controllers)
        self.late_binding = LateBinding(self.world, travel, self.panel)
        self.supply = Supply(self, scenario, seed, streams)
        self.services: list[PickService | ReplenishmentService] = [
            *(
                PickService(self, station, given)
                for station, given in zip(
                    self.world.pick_stations, layout.pick_stations, strict=True
                )
            ),
            *(
                ReplenishmentService(self, station, given)
                for station, given in zip(
                    self.world.replenishment_stations, layout.replenishment_stations, strict=True
                )
            ),
        ]
        self.disturbances = DisturbanceSource(self, scenario.disturbances, seed)
        self.thinking = Thinking(self, pacing_of(pacing or InstantPacing(), seed))
        self._end_us = self.us_at(self.end_s)
        self._moved_us = 0
        self._afterwards: list[Callable[[], None]] = []
        self._handlers = self._traffic_handlers()

    def run(self, progress: Callable[[float, float], None] | None = None) -> None:
        """Simulate from time zero to the end.

        Parameters
        ----------
        progress
            Called with the simulated time so far and in total, about a hundred times.

        Raises
        ------
        StalledError
            If nothing can move any more (only possible in a layout that is not well-formed).
        OptimiserError
            If an optimiser failed and the pacing is one that repeats.
        ReplayError
            If the run that is replayed was another one.
        """
        try:
            self.thinking.begin()
            self._begin(progress)
            self._loop()
        finally:
            self.thinking.end()
        self.observers.run_ended(self.end_s)

    def _loop(self) -> None:
        agenda, phase, end_us = self.agenda, self.phase, self._end_us
        advance = self.traffic.advance
        while True:
            # an answer that comes while this waits goes into the agenda
            limit_us = self.thinking.limit_us(self.now_us)
            for brake in self.brakes:
                limit_us = min(limit_us, brake(self.now_us))
            until_us = min(agenda.next_us, end_us, limit_us)
            events = advance(until_us)
            if events:
                self._set_now(events[0][0])
                self._moved_us = self.now_us
                for _, kind, robot, value in events:
                    handler = self._handlers[kind]
                    if handler is not None:
                        handler(robot, value)
            else:
                self._set_now(until_us)
            agenda.run_due(self.now_us)
            phase.settle()
            while self._afterwards:
                self._do_afterwards()
                phase.settle()
            if self.now_us >= end_us and not events and agenda.next_us > end_us:
                break

    def exchange(self, choice: Choice) -> None:
        """Exchange a controller by hand at this instant; the run remembers it."""
        self.interventions.append((self.world.now_s, choice))
        self.phase.exchange(choice)

    def after_decisions(self, callback: Callable[[], None]) -> None:
        """Call back at this instant, as soon as the controllers have decided."""
        self._afterwards.append(callback)

    def _do_afterwards(self) -> None:
        callbacks, self._afterwards = self._afterwards, []
        for callback in callbacks:
            callback()

    def end_task(self, robot: int) -> None:
        """End a robot's task: it needs a new one."""
        self.world.end_task(self.world.robots[robot])
        self.phase.signal(Trigger.ROBOT_FREE, robot)

    @staticmethod
    def us_at(time_s: float) -> int:
        """Return the first microsecond that is not before a time."""
        time_us = ceil(time_s * 1e6)
        return time_us if time_us / 1e6 >= time_s else time_us + 1

    def _set_now(self, now_us: int) -> None:
        self.now_us = now_us
        self.world.now_s = now_us / 1e6

    def _traffic_handlers(self) -> list[Callable[[int, int], None] | None]:
        """Handler per kind of event; the others matter only to traffic itself."""
        handlers: list[Callable[[int, int], None] | None] = [None] * len(EventKind)
        handlers[EventKind.DEPARTED] = self.dispatch.departed
        handlers[EventKind.ARRIVED] = self.dispatch.departed
        handlers[EventKind.LIFT_STARTED] = self.dispatch.lift_started
        handlers[EventKind.AT_HEAD] = self.dispatch.at_head
        handlers[EventKind.SET_DOWN] = self.dispatch.set_down
        handlers[EventKind.IDLE] = self.dispatch.idle
        return handlers

    # --- what happens at fixed times --------------------------------------------------------

    def _begin(self, progress: Callable[[float, float], None] | None) -> None:
        observed = Observed(self.layout, self.scenario, self.world, self.traffic, self.disturbances)
        self.observers.run_started(observed)
        self.disturbances.begin()
        self.supply.top_up()
        self.phase.signal(Trigger.START)
        if self.warmup_s == 0:
            self._end_warmup()
        else:
            self.agenda.at(self.us_at(self.warmup_s), self._end_warmup, _LAST)
        if progress is not None:
            self._report(progress, 0)
        self.phase.settle()

    def _end_warmup(self) -> None:
        self.observers.warmup_ended(self.world.now_s)
        self.traffic.reset_statistics()
        for statistics in self.phase.statistics.values():
            statistics.reset()
        self._sample_again(1)

    def _sample_again(self, number: int) -> None:
        """Take the next sample, counted from the end of the warm-up, if it is within the run."""
        time_s = self.warmup_s + number * SAMPLE_S
        if time_s <= self.end_s:
            self.agenda.at(self.us_at(time_s), lambda: self._sample(number), _LAST)

    def _sample(self, number: int) -> None:
        if self.now_us - self._moved_us > STALL_S * 1e6 and self.traffic.blocked():
            raise StalledError(
                f"nothing has moved since {self._moved_us / 1e6:.0f} s\n"
                f"{self.traffic.state_report()}"
            )
        self.observers.sampled(self.world.now_s)
        self._sample_again(number + 1)

    def _report(self, progress: Callable[[float, float], None], percent: int) -> None:
        progress(self.world.now_s, self.end_s)
        if percent < 100:
            time_us = self._end_us * (percent + 1) // 100
            self.agenda.at(time_us, lambda: self._report(progress, percent + 1), _LAST)


def _stocked_world(layout: Layout, scenario: Scenario, seed: int) -> World:
    """Build the world at time zero."""
    skus = sku_set(scenario.skus)
    world = World(layout, skus)
    stock = initial_stock(skus, layout.pod_capacity, scenario.stock.initial_share, seed)
    world.stock(stock.pod.tolist(), stock.sku.tolist(), stock.units.tolist())
    return world
