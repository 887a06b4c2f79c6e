"""A demonstration: a run in which some or all robots are real or emulated instead of simulated."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from rmfs.demonstrator.server.clock import ROOM, RoomClock, WallClock
from rmfs.demonstrator.server.guided import GuidedTraffic
from rmfs.demonstrator.server.hub import Hub
from rmfs.demonstrator.server.journal import Journal
from rmfs.demonstrator.server.real import check_floor
from rmfs.errors import InputError
from rmfs.simulation.result import Run
from rmfs.simulation.run import simulate
from rmfs.traffic import TIME_WINDOWS

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from rmfs.layout.model import Layout


@dataclass
class Demonstration:
    """A demonstration: its real or emulated robots, and the server's sessions with them.

    Attributes
    ----------
    hub
        The server's sessions with the real or emulated robots.
    robots
        Index in the layout of each real or emulated robot, by the robot's name.
    tags
        The tag of every waypoint.
    journal
        File of received messages. If it exists, the run first processes the messages in it again
        and then continues with new ones.
    is_emulated
        Whether an emulated room, a program that emulates the floor and the robots, keeps the clock
        of the demonstration.
    past_failure
        Whether to omit the messages received in the tick (step of 50 ms) in which the server
        failed.
    """

    hub: Hub
    robots: dict[str, int]
    tags: Sequence[str]
    journal: Path
    is_emulated: bool
    past_failure: bool = False
    traffic: GuidedTraffic | None = None

    def run(self, *inputs: Any, seed: int = 0, **options: Any) -> Run:
        """Run a simulation in which the robots in `robots` are real or emulated.

        Parameters
        ----------
        inputs, seed, options
            As for `rmfs.simulate`.

        Raises
        ------
        InputError
            If an argument is invalid.
        RoomGoneError
            If the emulated room stops responding.
        """
        settings = {"inputs": [str(given) for given in inputs], "seed": seed, **_plain(options)}
        maker = partial(self._make, {**settings, "robots": self.robots})
        try:
            return simulate(*inputs, seed=seed, traffic_maker=maker, **options)
        finally:
            if self.traffic is not None:
                self.traffic.end()
            self.hub.close()

    def _make(self, settings: dict[str, Any], layout: Layout, **options: Any) -> GuidedTraffic:
        if options["planner"].name != TIME_WINDOWS.name:
            raise InputError(
                f"controllers: path planning: real robots require {TIME_WINDOWS.name}, whose plans "
                f"can be delayed (given: {options['planner'].name})"
            )
        check_floor(layout, self.tags)
        journal = Journal(self.journal, settings, past_failure=self.past_failure)
        begin_us = max(0, journal.begins_us)
        clock = RoomClock() if self.is_emulated else WallClock(begin_us)
        self.traffic = GuidedTraffic(
            layout, self.robots, self.tags, self.hub, clock, journal, **options
        )
        return self.traffic


def expected(robots: dict[str, int], *, is_emulated: bool) -> list[str]:
    """Return the names of all clients that may connect: the robots, and an emulated room if any."""
    return [*robots, ROOM] if is_emulated else [*robots]


def _plain(options: dict[str, Any]) -> dict[str, Any]:
    """Return the options that influence the course of a demonstration."""
    kept: Callable[[str], bool] = ("overrides", "pacing", "allow_not_well_formed").__contains__
    return {name: value for name, value in options.items() if kept(name)}
