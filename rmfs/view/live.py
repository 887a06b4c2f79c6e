"""A live run, and the exchange of requests and data between its thread and the pages' threads.

Only the run's own thread changes the simulation. Requests from pages are queued here, and the run
processes them before it advances further. Data for a page are copied in the run's thread and packed
in the page's thread.
"""

from __future__ import annotations

import threading
import time
from functools import partial
from typing import TYPE_CHECKING

from rmfs.control.choices import check_together, choose
from rmfs.control.files import names_a_file
from rmfs.control.problems import Problem
from rmfs.errors import InputError
from rmfs.measure.events import EventLog
from rmfs.references import installed_only
from rmfs.simulation.agenda import NEVER_US
from rmfs.view import scene
from rmfs.view.asking import Exchange, Known, News, concern_of, page_name
from rmfs.view.container import pack
from rmfs.view.pace import Pace

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from rmfs.config import Table
    from rmfs.control.choices import Choice
    from rmfs.simulation.kernel import Kernel

ABSENT_S = 90.0
"""Wall time without a request, in s, after which a page counts as gone. A hidden page may send
requests only once a minute."""

BETWEEN_NEWS_S = 0.15
"""Processor time, in s, that a run without a speed limit gets between two answers to pages."""

LONGEST_WAIT_S = 1.0
"""Wall time, in s, after which a page is answered even if the run has had less processor time."""

MOST_PAGES = 1000
"""Maximum number of pages that watch one run."""

FIXED = frozenset({Problem.PP})
"""Problems whose controllers cannot be exchanged, because the controllers own the robots' plans."""


class LiveRun:
    """A live run: provides pages with its state, and applies their requests.

    Parameters
    ----------
    names
        Layout, scenario and controllers, as the user named them.
    title
        Title of the run on the page.
    speed
        Simulated seconds per wall second, at the beginning and again after the last page has left.
        Default: as fast as possible.

    Attributes
    ----------
    events
        The observer to pass to `rmfs.simulate`, together with `drive` as the driver.

    Raises
    ------
    InputError
        If the speed is out of range (see `Pace`).
    """

    def __init__(self, names: Mapping[str, str], *, title: str, speed: float | None = None) -> None:
        self.events = EventLog()
        self._names, self._title = dict(names), title
        self._pace = Pace(speed)
        self._meeting = threading.Condition()
        self._asked: list[News] = []
        self._exchanges: list[Exchange] = []
        self._under_way: list[Exchange] = []
        self._pages: dict[str, float] = {}
        self._left: set[str] = set()
        self._visited = False
        self._simulation: Kernel | None = None
        self._ended = ""
        self._braking = False
        self._answered_s = time.process_time()

    # --- the run's thread -----------------------------------------------------------------------

    def drive(
        self, simulation: Kernel, progress: Callable[[float, float], None] | None = None
    ) -> None:
        """Simulate a run to its end, at the pace that its pages set, and answer their requests."""
        with self._meeting:
            self._simulation = simulation
            self._brake(on=True)
            self._meeting.notify_all()
        simulation.drive(progress, self._limit_us)
        self.close("the run has ended")

    def _limit_us(self, now_us: int) -> int:
        return self.limit_us(now_us) if self._braking else NEVER_US

    def limit_us(self, now_us: int) -> int:
        """Return the simulated time, in us, up to which the run may advance now.

        While the run is paused, or ahead of the speed that was set, this method waits and answers
        requests from the open pages.
        """
        with self._meeting:
            while True:
                self._attend(now_us)
                if self._exchanges:
                    return self._exchange(now_us)
                limit_us = self._pace.limit_us(now_us, time.monotonic())
                if limit_us is not None:
                    self._brake(on=not self._pace.is_free)
                    return limit_us
                wait_s = self._pace.wait_s(now_us, time.monotonic())
                self._meeting.wait(1.0 if wait_s is None else min(wait_s, 1.0))

    def _attend(self, now_us: int) -> None:
        """Answer the pages, and remove pages that are gone."""
        for news in self._asked:
            self._answer(news, now_us)
        self._asked.clear()
        gone = [p for p, at_s in self._pages.items() if time.monotonic() - at_s > ABSENT_S]
        for page in gone:
            self._leave(page)

    def _exchange(self, now_us: int) -> int:
        """Schedule the requested exchanges of controllers for now, and return the current time."""
        assert self._simulation is not None
        for wish in self._exchanges:
            self._simulation.agenda.at(now_us, partial(self._install, wish))
        self._under_way += self._exchanges
        self._exchanges.clear()
        return now_us

    def _install(self, wish: Exchange) -> None:
        """Exchange a controller; if it does not fit the run, the page gets the error."""
        assert self._simulation is not None
        simulation, choice = self._simulation, wish.choice
        with concern_of(wish):
            simulation.phase.require_possible(choice)
            simulation.exchange(choice)
        self._under_way.remove(wish)

    def _answer(self, news: News, now_us: int) -> None:
        with concern_of(news):
            self._copy(news, now_us)

    def _copy(self, news: News, now_us: int) -> None:
        assert self._simulation is not None
        news.motion, motion = self._simulation.traffic.trace_after(news.known.motion)
        news.events = self.events.columns(news.known.events)
        # of this very instant more may come
        known_us = now_us if self._ended else now_us - 1
        news.header = {
            "known_s": max(known_us, 0) / 1e6,
            "known": {"motion": motion, "events": len(self.events)},
            "ended": self._ended,
            "paused": self._pace.paused,
            "speed": self._pace.speed,
            "controllers": {str(p): choice.to_table() for p, choice in self._choices().items()},
            "details": list(self.events.details),
        }

    # --- the pages' threads ---------------------------------------------------------------------

    def scene(self) -> bytes:
        """Return the packed scene of the whole run so far, including the warehouse."""
        with self._meeting:
            self._visited = True
            self._meeting.notify_all()
        news = self._news(Known())
        simulation = self._simulation
        assert simulation is not None
        header = scene.head(
            simulation.layout,
            names=self._names,
            seed=simulation.seed,
            warmup_s=simulation.warmup_s,
            end_s=simulation.end_s,
            title=self._title,
            details=news.header["details"],
            sku_names=simulation.world.skus.names,
            pickers=simulation.scenario.pickers is not None,
        )
        return pack(
            {**header, "live": news.header},
            {
                **scene.describe(simulation.layout, simulation.world.skus.space_per_unit),
                **scene.motion(news.motion, simulation.layout.robots),
                **scene.happenings(news.events),
            },
        )

    def news(self, known: Known, page: str = "") -> bytes:
        """Return the packed motion and events that a page does not know yet.

        On the page, a new row of motion replaces all rows of the same robot that start at the same
        time or later.

        Parameters
        ----------
        known
            How many rows of motion and how many events the page already has.
        page
            Name of the requesting page. A page counts as gone once its last request is more than
            `ABSENT_S` seconds old.

        Raises
        ------
        InputError
            If the name is invalid, or too many pages are open.
        """
        if page:
            with self._meeting:
                self._is_here(page_name(page))
            self._spare()
        news = self._news(known)
        assert self._simulation is not None
        robots = self._simulation.layout.robots
        return pack(
            {"details": news.header["details"], "live": news.header},
            {**scene.motion(news.motion, robots), **scene.happenings(news.events)},
        )

    def control(self, wish: Table) -> None:
        """Pause, step or resume as requested by `{"do": "pause" | "step" | "run", ...}`.

        For `step`, `by_s` is the length of the step in simulated seconds (0: to the next event).
        For `run`, `speed` is in simulated seconds per wall second (None: as fast as possible).
        `page` may name the sender, so that late requests from a closed page are ignored.

        Raises
        ------
        InputError
            If `do` or `page` is invalid, or a number is out of range.
        ValueError, TypeError
            If `by_s` or `speed` is not a number.
        """
        by_s, speed = float(wish.get("by_s", 0)), wish.get("speed")
        speed = None if speed is None else float(speed)
        with self._meeting:
            if "page" in wish and not self._is_here(page_name(wish["page"])):
                return
            match wish.get("do"):
                case "pause":
                    self._pace.pause()
                case "step":
                    self._pace.step(self._now_us, by_s)
                case "run":
                    self._pace.run(speed)
                case other:
                    raise InputError(f"do: must be pause, step or run (given: {other!r})")
            self._disturb()

    def exchange(self, problem: str, table: Table) -> None:
        """Install another controller for a decision problem at the current time of the run.

        Parameters
        ----------
        table
            Name and parameters of the new controller, as in a controllers file.

        Raises
        ------
        InputError
            If the controller of this problem cannot be exchanged, `table` is invalid or names a
            file, the new controller does not fit the run or the other controllers, or the run has
            ended.
        """
        if problem not in set(Problem) - FIXED:
            raise InputError(f"{problem}: cannot be exchanged during a run")
        if names_a_file(problem, table):
            raise InputError("exchange: files can be chosen on the command line only")
        with installed_only():  # a page may name no code
            chosen = choose(Problem(problem), table, "exchange")
        with self._meeting:
            if self._ended:
                raise InputError(self._ended)
            self._await_start()
            check_together({**self._choices(), chosen.problem: chosen}, "exchange")
            wish = Exchange(choice=chosen)
            self._exchanges.append(wish)
            self._disturb()
        wish.wait()

    def leave(self, page: str) -> None:
        """Record that a page was closed; if none is left, the run resumes at its initial speed."""
        with self._meeting:
            if page_name(page) in self._pages or len(self._left) < MOST_PAGES:
                self._left.add(page)
                self._leave(page)

    def close(self, reason: str) -> None:
        """Mark the run as ended, answer pending requests, and report `reason` to all pages."""
        with self._meeting:
            if self._ended:
                return
            self._ended = reason
            for news in self._asked:
                self._answer(news, self._now_us)
            self._asked.clear()
            for wish in [*self._exchanges, *self._under_way]:
                wish.fail(InputError(reason))
            self._exchanges.clear()
            self._meeting.notify_all()

    def await_page(self, patience_s: float) -> None:
        """Wait until a page requests the scene, at most `patience_s` seconds of wall time."""
        with self._meeting:
            self._meeting.wait_for(lambda: self._visited, patience_s)

    def await_farewell(self, patience_s: float) -> None:
        """Wait until all pages have left, at most `patience_s` seconds of wall time.

        Meanwhile, the pages can load the end of the run.
        """
        end_s = time.monotonic() + patience_s
        # a page that is still being built has not said yet that it is there
        while (self._pages or (self._visited and not self._left)) and time.monotonic() < end_s:
            time.sleep(0.05)

    def _is_here(self, page: str) -> bool:
        """Record that a page is open, and return True; if it has been closed, return False."""
        if page in self._left:
            return False
        if page not in self._pages and len(self._pages) >= MOST_PAGES:
            raise InputError(f"{MOST_PAGES} pages are open already")
        self._pages[page] = time.monotonic()
        return True

    def _spare(self) -> None:
        """Wait until a free run has had some processor time since the last answer to a page."""
        end_s = time.monotonic() + LONGEST_WAIT_S
        while self._pace.is_free and not self._ended and time.monotonic() < end_s:
            missing_s = self._answered_s + BETWEEN_NEWS_S - time.process_time()
            if missing_s <= 0:
                break
            time.sleep(max(missing_s, 0.01))
        self._answered_s = time.process_time()

    def _await_start(self) -> None:
        """Wait until the run has begun.

        Raises
        ------
        InputError
            If the run ended before it began.
        """
        self._meeting.wait_for(lambda: self._simulation is not None or self._ended)
        if self._simulation is None:
            raise InputError(self._ended)

    def _choices(self) -> dict[Problem, Choice]:
        """Return the controllers that are installed or about to be installed."""
        assert self._simulation is not None
        coming = {wish.choice.problem: wish.choice for wish in self._exchanges}
        return {**self._simulation.phase.choices, **coming}

    @property
    def _now_us(self) -> int:
        return 0 if self._simulation is None else self._simulation.now_us

    def _disturb(self) -> None:
        """Make the run process its requests before it advances further."""
        self._brake(on=True)
        self._meeting.notify_all()

    def _brake(self, *, on: bool) -> None:
        """Set whether the run calls `limit_us`; a run that is free (see `Pace`) need not."""
        if self._simulation is None:
            return
        self._braking = on

    def _leave(self, page: str) -> None:
        if self._pages.pop(page, None) is not None and not self._pages:
            self._pace.let_go()
            self._disturb()

    def _news(self, known: Known) -> News:
        news = News(known=known)
        with self._meeting:
            self._await_start()
            if self._ended:
                self._answer(news, self._now_us)
            else:
                self._asked.append(news)
                self._disturb()
        news.wait()
        return news
