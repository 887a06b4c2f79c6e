"""Inputs of the energy model of `rmfs.traffic`: parameters of robots, and masses of pods."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.observer import Observer

if TYPE_CHECKING:
    from rmfs.scenario.parameters import Energy
    from rmfs.traffic import Traffic
    from rmfs.world import World
    from rmfs.world.orders import Bundle, Order


def model_of(given: Energy) -> list[float]:
    """Return the energy parameters of robots in the order that `Traffic.count_energy` expects."""
    return [
        given.robot_kg,
        given.rolling_resistance,
        given.inertia_share,
        given.drive_efficiency,
        given.recuperation_share,
        given.turning_resistance_m,
        given.gyration_m,
        given.lift_m,
        given.lift_efficiency,
        given.standby_w,
        given.standby_loaded_w,
    ]


class PodMasses(Observer):
    """Keeps traffic informed of the mass of each pod, including its contents.

    Parameters
    ----------
    given
        The scenario's energy parameters, which include the mass of an empty pod, and the mass of
        goods per unit of space.
    fleet
        Traffic, which is notified of each change of a mass.
    """

    def __init__(self, given: Energy, world: World, fleet: Traffic) -> None:
        self._empty_kg, self._kg_per_space = given.pod_kg, given.goods_kg_per_space
        self._used = world.inventory.used
        self._fleet = fleet

    def all_kg(self) -> list[float]:
        """Return the masses of all pods with their contents, in kg, one per pod."""
        masses: list[float] = (self._empty_kg + self._kg_per_space * self._used).tolist()
        return masses

    def unit_picked(
        self,
        time_s: float,
        order: Order,
        sku: int,
        pod: int,
        robot: int,
        station: int,
        late_bound: bool,
    ) -> None:
        """Reduce the mass of a pod by that of the picked unit."""
        self._weigh(pod)

    def bundle_stored(self, bundle: Bundle, robot: int) -> None:
        """Increase the mass of a pod by that of the stored bundle."""
        self._weigh(bundle.pod)

    def _weigh(self, pod: int) -> None:
        self._fleet.set_pod_mass(pod, self._empty_kg + self._kg_per_space * float(self._used[pod]))
