"""Long-run energy balance of a fleet."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rmfs.errors import InputError
from rmfs.layout.charging import RecoveryKind
from rmfs.simulation.charging.needs import GRAVITY

if TYPE_CHECKING:
    from rmfs.layout.model import Layout
    from rmfs.scenario.parameters import Energy


class Balance(NamedTuple):
    """Power that a fleet can receive in the long run, and the minimum power that it needs.

    Attributes
    ----------
    given_w
        Total power in W that all chargers, swap stations and waypoints with inductive charging can
        supply.
    least_w
        Minimum power that the fleet needs, in W: the power of the robots' electronics alone.
    has_stations
        Whether there is a charger or swap station, to which a robot can be sent for energy.
    """

    given_w: float
    least_w: float
    has_stations: bool


def waypoint_power_w(layout: Layout, energy: Energy) -> dict[int, float]:
    """Return the charging power in W of each waypoint at which robots can charge."""
    power: dict[int, float] = {}
    queues: list[tuple[int, ...]] = []
    given = energy.inductive
    if given is not None:
        if given.at != "replenishment-stations":
            queues += [station.queue for station in layout.pick_stations]
        if given.at != "pick-stations":
            queues += [station.queue for station in layout.replenishment_stations]
        for queue in queues:
            power.update(dict.fromkeys(queue[: given.places], given.power_w))
    for other in layout.other_stations:
        if isinstance(other.kind, RecoveryKind) and other.kind.head_w:
            power[other.waypoint] = other.kind.head_w
    return power


def balance(layout: Layout, energy: Energy) -> Balance:
    """Return the power that a fleet can receive, and the minimum power that it needs."""
    given_w = sum(
        other.kind.long_run_w
        for other in layout.other_stations
        if isinstance(other.kind, RecoveryKind) and not other.kind.head_w
    )
    given_w += sum(waypoint_power_w(layout, energy).values())
    stations = any(isinstance(other.kind, RecoveryKind) for other in layout.other_stations)
    return Balance(given_w, layout.robots * energy.standby_w, stations)


def working_w(layout: Layout, energy: Energy) -> float:
    """Estimate the power in W that a working fleet consumes.

    All robots are assumed to drive at top speed all the time, and to carry a half-full pod half of
    the time. Starts and turns take more power, and waiting takes less; in the shipped layouts,
    these effects roughly cancel. The result is not a bound.
    """
    pod_kg = energy.pod_kg + energy.goods_kg_per_space * float(layout.pod_capacity.mean()) / 2
    speed = sum(kind.top_speed_m_s for kind in layout.robot_kinds) / len(layout.robot_kinds)
    rolling_w = energy.rolling_resistance * GRAVITY * speed * (energy.robot_kg + pod_kg / 2)
    standby_w = (energy.standby_w + energy.standby_loaded_w) / 2
    return layout.robots * (rolling_w / energy.drive_efficiency + standby_w)


def refuse(layout: Layout, energy: Energy) -> None:
    """Raise an error if batteries cannot be charged, or if the charging power is too low.

    Raises
    ------
    InputError
        If nothing can charge batteries, or if the available power is less than the fleet needs at
        standstill; in the latter case, the message states the deficit.
    """
    found = balance(layout, energy)
    if not found.given_w:
        raise InputError(
            "scenario.energy.battery: batteries cannot be charged: the layout has no station of "
            "the kind charger or swap, and scenario.energy.inductive is not given"
        )
    if found.given_w < found.least_w:
        raise InputError(
            f"scenario.energy.battery: {layout.robots} robots draw {found.least_w:g} W even at "
            f"standstill, but all chargers together supply only {found.given_w:g} W: "
            f"{found.least_w - found.given_w:g} W are missing in the long run"
        )
