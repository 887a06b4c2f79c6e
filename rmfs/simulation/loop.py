"""The loop of a run: one instant after the other, as far as it is told."""

from __future__ import annotations

from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING

from rmfs.simulation.agenda import LAST, us_at
from rmfs.simulation.decision import Decision
from rmfs.traffic import EventKind

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.control.view import View
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
    """Told the present time, says up to which time (us) may be simulated; waits as it likes."""

SAMPLE_S = 60.0
"""Time between two samples."""

STALL_S = 3600.0
"""So long nothing may move while robots wait for a way before a run is given up."""


class StalledError(RuntimeError):
    """Nothing can move any more; the message lists every robot."""


class Loop:
    """Lets traffic move, calls what is due, and has decided what that calls for, again and again.

    All that happens at one instant is handled before the controllers are asked. How often a run
    stops on its way changes nothing.

    Attributes
    ----------
    agenda
        The present time, and what is to come.
    warmup_s, end_s
        When measuring begins, and when the run ends.
    wall_s
        Wall time of simulating so far.
    instants
        At how many instants something has happened so far.
    """

    agenda: Agenda
    world: World
    traffic: Traffic
    events: Events
    view: View
    phase: DecisionPhase
    controller_set: ControllerSet
    deciding: Deciding
    optimisers: OptimiserGateway
    warmup_s: float
    end_s: float

    def __init__(self, dispatch: Dispatch) -> None:
        self._end_us = us_at(self.end_s)
        self._moved_us = 0
        self._begun = self._ended = False
        self.wall_s = 0.0
        self.instants = 0
        self._unsettled = self._quiet = False
        self._handlers = _traffic_handlers(dispatch)

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
            self._begun = self._unsettled = True
            self._begin()
            if self.warmup_s == 0:
                self._end_warmup()
            else:
                self.agenda.at(us_at(self.warmup_s), self._end_warmup, LAST)
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
        agenda, handlers = self.agenda, self._handlers
        events = self.traffic.advance(until_us)
        agenda.now_us = now_us = events[0][0] if events else until_us
        self.world.now_s = now_us / 1e6
        if events:
            self._moved_us = now_us
            for _, kind, robot, value in events:
                handler = handlers[kind]
                if handler is not None:
                    handler(robot, value)
        self._quiet = not events
        agenda.run_due()
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

    @property
    def decision(self) -> Decision | None:
        """The decision that waits to be taken outside, if there is one."""
        question = self.phase.outside.pending
        return None if question is None else Decision(question, self)

    # --- what happens at fixed times --------------------------------------------------------------

    def _begin(self) -> None:
        """Let all that comes by itself begin."""
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
