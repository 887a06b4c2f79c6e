"""Service at a charger: a robot stays until its battery has reached the target level."""

from __future__ import annotations

from math import ceil, isfinite
from typing import TYPE_CHECKING, Any

from rmfs.layout.charging import RecoveryKind
from rmfs.simulation.tasks import end_task
from rmfs.world.charging import ChargeTask

if TYPE_CHECKING:
    from rmfs.layout.model import OtherStation
    from rmfs.simulation.agenda import Agenda
    from rmfs.simulation.events import Events
    from rmfs.world import World
    from rmfs.world.charging import RecoveryStation


class ChargeService:
    """The service of one charger; it determines when a robot stops charging.

    Attributes
    ----------
    power_w
        Present charging power, in W; 0 while the charger is out of service.
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
        assert isinstance(layout.kind, RecoveryKind)
        self._agenda, self._world, self._events = agenda, world, events
        self.station = station
        self.power_w = layout.kind.head_w
        self._task: ChargeTask | None = None
        self._begun_us = 0
        self._entry = -1

    @property
    def is_charging(self) -> bool:
        """Whether a robot is charging at this charger."""
        return self._task is not None

    def go_on(self) -> None:
        """Start charging the robot at the charger, if a robot is there."""
        robot = self.station.robot
        task: Any = self._world.robots[robot].task if robot >= 0 else None
        if self._task is None and isinstance(task, ChargeTask):
            self._task, self._begun_us = task, self._agenda.now_us
            self._enter()

    def set_power(self, power_w: float) -> None:
        """Change the charging power, in W; the caller must also change it in `Traffic`."""
        self.power_w = power_w
        if self._task is not None:
            self._cancel()
            self._enter()

    def unplug(self) -> None:
        """End the charging of the robot at the charger."""
        self._cancel()
        self._end()

    def run_ended(self) -> None:
        """Report the charging in progress, if any, when the run ends."""
        if self._task is not None:
            self._report()

    def _report(self) -> None:
        """Report the period from the beginning of charging until now as busy."""
        self._events.station_busy(
            self.station.index, self._begun_us / 1e6, self._agenda.now_us / 1e6
        )

    def _enter(self) -> None:
        """Schedule the end of charging, if the target level can be reached."""
        batteries, task = self._world.batteries, self._task
        assert batteries is not None and task is not None
        until = min(task.until_share, batteries.given.full_share)
        seconds = batteries.seconds(batteries.share(task.robot), until, self.power_w)
        if isfinite(seconds):
            self._entry = self._agenda.after(ceil(seconds * 1e6), self._end)

    def _cancel(self) -> None:
        if self._entry >= 0:
            self._agenda.cancel(self._entry)
            self._entry = -1

    def _end(self) -> None:
        task, self._task, self._entry = self._task, None, -1
        assert task is not None
        self._report()
        end_task(self._world, self._events, task.robot)
