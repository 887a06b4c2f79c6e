"""Detects rules that decide nothing although work waits, so that users can be warned."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.problems import Problem

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.simulation.controller_set import ControllerSet
    from rmfs.simulation.statistics import DecisionStatistics
    from rmfs.world import World

SHARE = 0.5
"""A rule is reported if the time without a decision at the end of a run is at least this share of
the run, and at least `LEAST_S`."""
LEAST_S = 300.0
"""Minimum time without a decision at the end of a run, in s."""


class IdleRuleWarning(UserWarning):
    """A rule has decided nothing for a long time although work waits."""


def idle_rules(
    world: World,
    controllers: ControllerSet,
    statistics: Mapping[Problem, DecisionStatistics],
    end_s: float,
    outside: frozenset[Problem] = frozenset(),
) -> list[str]:
    """Describe the rules of POA, RPS, ROA and TA that have long been idle although work waits.

    Parameters
    ----------
    end_s
        End of the run, in simulated seconds since its start.
    outside
        Decision problems decided outside the simulation, whose rules are exempt.

    Returns
    -------
    list of str
        One line for each such rule.
    """
    found = []
    for problem in (Problem.POA, Problem.RPS, Problem.ROA, Problem.TA):
        rule, told = controllers[problem], statistics[problem]
        idle_s = end_s - max(told.last_s, 0.0)
        if rule.is_dummy or problem in outside or idle_s < max(SHARE * end_s, LEAST_S):
            continue
        waits = _waits(problem, world, after_rps=Problem.RPS in rule.waits_for)
        if waits:
            never = "has never made a decision"
            last = f"has made no decision since {told.last_s:.0f} s"
            since = never if told.last_s < 0 else last
            found.append(
                f"{problem} {told.name} {since} (the run ended at {end_s:.0f} s), although {waits}"
            )
    return found


def _waits(problem: Problem, world: World, *, after_rps: bool) -> str:
    """Describe what waits for a decision; empty if nothing could be decided.

    Parameters
    ----------
    after_rps
        Whether bundles must be released by RPS before they can be decided.
    """
    if problem is Problem.POA:
        slots = sum(station.free_slots for station in world.pick_stations if station.active)
        return f"{len(world.orders)} orders wait and {slots} slots are free" * bool(
            len(world.orders) and slots
        )
    if problem is Problem.RPS:
        room = float((world.inventory.capacity - world.inventory.load).max(initial=0.0))
        count = sum(bundle.space <= room for bundle in world.bundles.without_pod.values())
        return f"{count} bundles wait for a pod" * bool(count)
    if problem is Problem.ROA:
        stations = [station for station in world.replenishment_stations if station.active]
        room = max((station.free_space for station in stations), default=0.0)
        released = [bundle for held in world.bundles.released.values() for bundle in held]
        bundles = released if after_rps else world.bundles.without_station.values()
        count = sum(bundle.space <= room for bundle in bundles)
        return f"{count} bundles wait for a station with room for them" * bool(count)
    idle = len(world.asking) + len(world.resting)
    work = any(station.has_open_work for station in world.work_stations)
    return f"{idle} robots are idle and stations have work" * bool(idle and work)
