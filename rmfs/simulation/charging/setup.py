"""Creation of a run's batteries from scenario and layout."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.random import Stream, generator
from rmfs.simulation.charging.balance import refuse, waypoint_power_w
from rmfs.simulation.energy import PodMasses, model_of
from rmfs.world.batteries import Batteries, initial_j

if TYPE_CHECKING:
    from rmfs.layout.model import Layout
    from rmfs.observer import Observer
    from rmfs.scenario.parameters import Energy
    from rmfs.traffic import Traffic
    from rmfs.world import World


def count_energy(
    given: Energy | None, layout: Layout, world: World, fleet: Traffic, seed: int
) -> list[Observer]:
    """Set up energy measurement and batteries, as far as the scenario specifies them.

    Returns
    -------
    list[Observer]
        Observers that the run needs to measure energy; empty if energy is not measured.

    Raises
    ------
    InputError
        If there are batteries but they cannot be charged, or the charging power is too low.
    """
    if given is None:
        return []
    masses = PodMasses(given, world, fleet)
    battery = given.battery
    if battery is None:
        fleet.count_energy(model_of(given), masses.all_kg())
        return [masses]
    refuse(layout, given)
    power_w = np.zeros(layout.waypoints)
    for waypoint, watts in waypoint_power_w(layout, given).items():
        power_w[waypoint] = watts
    batteries = world.batteries = Batteries(battery, fleet)
    fleet.count_energy(
        model_of(given),
        masses.all_kg(),
        initial_j=initial_j(battery, layout.robots, generator(seed, Stream.BATTERIES).random),
        battery=(batteries.capacity_j, battery.taper_from_share),
        power_w=power_w.tolist(),
    )
    return [masses]
