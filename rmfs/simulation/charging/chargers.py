"""The chargers of a run: they may fail, and robots can be sent away from them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.layout.charging import RecoveryKind
from rmfs.simulation.charging.service import ChargeService

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.control.decisions import Unplug
    from rmfs.layout.model import Layout
    from rmfs.simulation.service import Service
    from rmfs.traffic import Traffic


class Chargers:
    """All chargers of a run.

    Attributes
    ----------
    stations
        Indices of the chargers in the common numbering of all stations.
    """

    def __init__(self, layout: Layout, services: Sequence[Service], fleet: Traffic) -> None:
        self._layout, self._fleet = layout, fleet
        self._services = {
            number: service
            for number, service in enumerate(services)
            if isinstance(service, ChargeService)
        }
        self.stations = list(self._services)

    def unplug(self, decision: Unplug) -> None:
        """Send a robot away from its charger.

        Raises
        ------
        ValueError
            If the robot is not charging at a charger.
        """
        service = self._services.get(decision.robot.station)
        if service is None or not service.is_charging:
            raise ValueError(f"robot {decision.robot.index} is not charging at a charger")
        service.unplug()

    def run_ended(self) -> None:
        """Report what chargers are doing when the run ends."""
        for service in self._services.values():
            service.run_ended()

    def set_working(self, station: int, working: bool) -> None:
        """Set whether a charger works or has failed."""
        plan = self._layout.stations[station]
        assert isinstance(plan.kind, RecoveryKind)
        power_w = plan.kind.head_w if working else 0.0
        self._fleet.set_power(plan.waypoint, power_w)
        self._services[station].set_power(power_w)
