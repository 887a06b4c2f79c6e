"""Battery swap: a robot receives the fullest battery in stock and leaves its own behind."""

from __future__ import annotations

from math import ceil
from typing import TYPE_CHECKING, Any

from rmfs.simulation.tasks import end_task
from rmfs.world.charging import ChargeTask

if TYPE_CHECKING:
    from rmfs.layout.model import OtherStation
    from rmfs.simulation.agenda import Agenda
    from rmfs.simulation.events import Events
    from rmfs.world import World
    from rmfs.world.charging import RecoveryStation


class SwapService:
    """One swap station and its stock of batteries, which charge independently of each other.

    Attributes
    ----------
    stock
        For each battery in stock, a pair: the level (share of capacity) with which the battery
        arrived, and the time in s at which it arrived.
    """

    def __init__(
        self,
        station: RecoveryStation,
        layout: OtherStation,
        *,
        agenda: Agenda,
        world: World,
        events: Events,
    ) -> None:
        self._agenda, self._world, self._events = agenda, world, events
        self.station = station
        self.parameters = layout.kind.parameters
        full = world.batteries.given.full_share if world.batteries is not None else 1.0
        self.stock = [(full, 0.0)] * self.parameters.batteries
        self._task: ChargeTask | None = None

    def go_on(self) -> None:
        """Begin the swap for the robot at the station; the robot waits until a battery is ready."""
        robot = self.station.robot
        task: Any = self._world.robots[robot].task if robot >= 0 else None
        if self._task is None and isinstance(task, ChargeTask):
            self._task = task
            begin_us = self._agenda.now_us + ceil(self._ready_in_s() * 1e6)
            end_us = begin_us + round(self.parameters.swap_s * 1e6)
            self._events.station_busy(self.station.index, begin_us / 1e6, end_us / 1e6)
            self._agenda.at(end_us, self._end)

    def levels(self) -> list[float]:
        """Return the present level of each battery in stock, as a share of its capacity."""
        batteries, now_s = self._world.batteries, self._world.now_s
        assert batteries is not None
        full, power_w = batteries.given.full_share, self.parameters.power_w
        return [
            level if level >= full else min(full, batteries.charged(level, power_w, now_s - since))
            for level, since in self.stock
        ]

    def _ready_in_s(self) -> float:
        batteries = self._world.batteries
        assert batteries is not None
        ready = min(self.parameters.ready_share, batteries.given.full_share)
        return batteries.seconds(max(self.levels()), ready, self.parameters.power_w)

    def _end(self) -> None:
        """Exchange the batteries: the fullest for the robot's own."""
        task, self._task = self._task, None
        batteries = self._world.batteries
        assert task is not None and batteries is not None
        levels = self.levels()
        best = levels.index(max(levels))
        left = batteries.share(task.robot)
        batteries.exchange(task.robot, levels[best])
        self.stock[best] = (left, self._world.now_s)
        end_task(self._world, self._events, task.robot)
