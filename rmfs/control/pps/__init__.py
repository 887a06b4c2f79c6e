"""Pod selection (PPS): which pod comes to a station, or which station a carried pod goes to."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, TypeVar

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation, ReplenishmentStation


class LateBinding(Parameters):
    """Parameters of every PPS rule."""

    late_picks: bool = True
    """Whether a pod on its way to a pick station is given requests that come up meanwhile."""
    late_bundles: bool = True
    """The same for bundles of a pod on its way to a replenishment station."""


P = TypeVar("P", bound=LateBinding)


class PodSelection(Controller[P]):
    """Chooses pods for robots that TA wants to work for a station.

    It is asked by TA, for an empty robot or for a pod that has been served. What the pod can serve
    at the station is bound to it by the simulation.
    """

    problem = Problem.PPS

    @abstractmethod
    def pick_pod(self, robot: Robot, station: PickStation) -> int:
        """Choose a pod at hand with units that open requests of the station want, or -1."""

    @abstractmethod
    def replenishment_pod(self, robot: Robot, station: ReplenishmentStation) -> int:
        """Choose a pod at hand for which bundles wait at the station, or -1."""

    @abstractmethod
    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Choose one of several stations that the pod of a robot can serve (at least one)."""
