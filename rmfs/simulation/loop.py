"""The main loop of a run, which processes one instant after another."""

from __future__ import annotations

from functools import partial
from math import inf
from time import perf_counter
from typing import TYPE_CHECKING

from rmfs.errors import InputError
from rmfs.simulation.agenda import LAST, us_at
from rmfs.simulation.collection import fewer_collections
from rmfs.simulation.decision import Decision
from rmfs.traffic import EventKind

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.control.view import View
    from rmfs.simulation.advice import Advice
    from rmfs.simulation.agenda import Agenda
    from rmfs.simulation.controller_set import ControllerSet
    from rmfs.simulation.deciding import Deciding
    from rmfs.simulation.dispatch import Dispatch
    from rmfs.simulation.events import Events
    from rmfs.simulation.optimisers import OptimiserGateway
    from rmfs.simulation.phase import DecisionPhase
    from rmfs.traffic import Traffic
    from rmfs.world import World

    Limit = Callable[[int], int]
    """Function of the present time in us. It returns the latest time in us that may be simulated
    now, and may block first."""

SAMPLE_S = 60.0
"""Simulated time between two samples of the state of the run, in s."""

STALL_S = 3600.0
"""A run is given up if nothing has moved for this long, in s, while robots wait for a path."""


class StalledError(RuntimeError):
    """Nothing has moved for `STALL_S`, yet robots wait for a path; the message lists all robots."""


class Loop:
    """Repeatedly advances traffic, makes the callbacks that are due, and lets controllers decide.

    Everything that is due at an instant is handled before the controllers are called. A run has the
    same results whether it is simulated by one call of `run` or by several calls of `run_until` or
    `step`.

    Attributes
    ----------
    agenda
        The current time, and the future events.
    warmup_s, end_s
        Start of the measured time, and end of the run, in s.
    wall_s
        Wall time spent on simulating so far, in s.
    instants
        Number of instants simulated so far.
    """

    agenda: Agenda
    world: World
    traffic: Traffic
    events: Events
    view: View
    phase: DecisionPhase
    controller_set: ControllerSet
    deciding: Deciding
    advice: Advice
    optimisers: OptimiserGateway
    warmup_s: float
    end_s: float

    def __init__(self, dispatch: Dispatch) -> None:
        # to the nearest microsecond, as in files: a sum of two times may be slightly too large
        self._end_us = round(self.end_s * 1e6)
        self._moved_us = 0
        self._begun = self._ended = False
        self.wall_s = 0.0
        self.instants = 0
        self._unsettled = self._quiet = False
        self._handlers = _traffic_handlers(dispatch)
        self._ignored = sum(1 << kind for kind in EventKind if kind not in self._handlers)

    @property
    def now_us(self) -> int:
        """Current time in microseconds; `world.now_s` is the same in seconds."""
        return self.agenda.now_us

    @property
    def now_s(self) -> float:
        """Current simulated time in s."""
        return self.world.now_s

    @property
    def ended(self) -> bool:
        """Whether the run has ended."""
        return self._ended

    def run(self, progress: Callable[[float, float], None] | None = None) -> None:
        """Simulate to the end.

        Parameters
        ----------
        progress
            Called about a hundred times, with the current simulated time and the end of the run,
            in s.

        Raises
        ------
        RuntimeError
            If a decision must be made outside the simulation; use `step` instead.
        StalledError
            If nothing has moved for `STALL_S` while robots waited for a path. With the default path
            planner, this is possible only in a layout that is not well-formed.
        RuleError
            If a user's controller decides something impossible.
        OptimiserError
            If an optimiser fails with a pacing other than `wall`, or if a worker process of the
            pacing `wall` cannot start.
        ReplayError
            If a replayed run deviates from the recorded one.
        """
        self.drive(progress)

    def drive(
        self,
        progress: Callable[[float, float], None] | None = None,
        limit: Limit | None = None,
    ) -> None:
        """Simulate to the end, like `run`, but never beyond a limit that changes over time.

        Parameters
        ----------
        limit
            Function called before every instant with the present time in us. It returns the latest
            time in us that may be simulated now, and may wait first, for example to keep the run in
            step with a web page that shows it.
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
        """Simulate up to a time in s, including everything at that time, but not beyond the end.

        Parameters
        ----------
        time_s
            The time; inf for the end of the run.

        Returns
        -------
        Decision or None
            The first decision that must be made outside the simulation, at which the simulation
            stops; None if no such decision comes up by that time.

        Raises
        ------
        InputError
            If the time is nan or -inf.
        """
        if not time_s > -inf:
            raise InputError(f"time_s {time_s}: must be a time in s, or inf for the end of the run")
        return self._go_on(min(us_at(min(time_s, self.end_s)), self._end_us))

    def step(self) -> Decision | None:
        """Simulate up to the next decision that is made outside the simulation.

        Returns
        -------
        Decision or None
            The decision. Until it has been answered, further calls return it again. None if the run
            has ended.
        """
        return self._go_on(self._end_us)

    def _go_on(self, until_us: int, limit: Limit | None = None) -> Decision | None:
        if not self._begun:
            self._begun = self._unsettled = True
            self._begin()
            if self.warmup_s == 0:
                self._end_warmup()
            else:
                self.agenda.at(round(self.warmup_s * 1e6), self._end_warmup, LAST)
        agenda, end_us = self.agenda, until_us
        if end_us < agenda.now_us:
            return self.decision
        started_s = perf_counter()
        try:
            with fewer_collections():
                return self._go_on_until(end_us, limit)
        finally:
            self.wall_s += perf_counter() - started_s

    def _go_on_until(self, end_us: int, limit: Limit | None) -> Decision | None:
        agenda, phase = self.agenda, self.phase
        limits = [limit] if limit is not None else []
        if self.optimisers.waits:
            limits.insert(0, self.optimisers.limit_us)
        while not self._ended:
            if not self._unsettled:
                allowed_us = end_us
                for one in limits:
                    # an answer that arrives during this wait enters the agenda
                    allowed_us = min(allowed_us, one(agenda.now_us))
                next_us = agenda.next_us
                self._move(next_us if next_us < allowed_us else allowed_us)
            while phase.settle():
                if not agenda.run_settled():
                    break
            else:
                return self.decision
            self._unsettled = False
            if agenda.now_us >= end_us and self._quiet and agenda.next_us > end_us:
                if end_us >= self._end_us:
                    self._end()
                return None
        return None

    def _move(self, until_us: int) -> None:
        """Process the next instant, up to a time."""
        self.instants += 1
        agenda, handlers = self.agenda, self._handlers
        events = self.traffic.advance(until_us, self._ignored)
        agenda.now_us = now_us = events[0][0] if events else until_us
        self.world.now_s = now_us / 1e6
        if events:
            self._moved_us = now_us
            for _, kind, robot, value in events:
                handlers[kind](robot, value)
        self._quiet = not events
        agenda.run_due()
        self._unsettled = True

    def _refuse_pending(self, decision: Decision | None) -> None:
        if decision is not None:
            raise RuntimeError(
                f"{decision.problem} is decided outside: use step(), which returns its decisions, "
                "instead of run()"
            )

    @property
    def decision(self) -> Decision | None:
        """The pending decision, to be made outside the simulation; None if there is none."""
        question = self.phase.outside.pending
        return None if question is None else Decision(question, self)

    # --- what happens at fixed times --------------------------------------------------------------

    def _begin(self) -> None:
        """Start all processes."""
        raise NotImplementedError

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
        """Schedule the next sample, counted from the end of the warm-up, within the run."""
        time_s = self.warmup_s + number * SAMPLE_S
        if time_s <= self.end_s:
            self.agenda.at(us_at(time_s), partial(self._sample, number), LAST)

    def _sample(self, number: int) -> None:
        if self.now_us - self._moved_us > STALL_S * 1e6 and self.traffic.blocked():
            raise StalledError(
                f"nothing has moved since {self._moved_us / 1e6:.0f} s\n"
                f"{self.traffic.state_report()}"
            )
        self.traffic.motion()  # lets robots discard their past moves
        self.events.sampled(self.world.now_s)
        self._sample_again(number + 1)


def _traffic_handlers(dispatch: Dispatch) -> dict[int, Callable[[int, int], None]]:
    """Return the handlers of events, by kind; other events matter only inside traffic."""
    return {
        int(EventKind.DEPARTED): dispatch.departed,
        int(EventKind.ARRIVED): dispatch.departed,
        int(EventKind.LIFT_STARTED): dispatch.lift_started,
        int(EventKind.AT_HEAD): dispatch.at_head,
        int(EventKind.SET_DOWN): dispatch.set_down,
        int(EventKind.IDLE): dispatch.idle,
    }
