"""Measures of the robots' energy and batteries; empty if these are not modelled."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import COUNT_OR_EMPTY, LESS, REAL, Column
from rmfs.measure.energy import WH
from rmfs.measure.measures.reckoning import ratio

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun

PARTS = ("drive", "turn", "lift", "standby", "recuperated")


class Energy(Measure):
    """Energy drawn by all robots."""

    columns = (
        Column(
            "energy_kwh",
            REAL,
            "kWh",
            "Energy drawn by all robots, less recovered braking energy; this column and the "
            "following ones up to energy_recuperated_kwh are empty if energy is not modelled",
            better=LESS,
        ),
        Column("energy_wh_per_unit", REAL, "Wh", "1,000 x energy_kwh / units_picked", better=LESS),
        Column(
            "energy_kwh_per_1000_units",
            REAL,
            "kWh",
            "energy_kwh per 1,000 picked units",
            better=LESS,
        ),
        Column("energy_drive_kwh", REAL, "kWh", "Energy drawn for driving"),
        Column("energy_turn_kwh", REAL, "kWh", "Energy drawn for turning on the spot"),
        Column("energy_lift_kwh", REAL, "kWh", "Energy drawn for lifting pods"),
        Column(
            "energy_standby_kwh",
            REAL,
            "kWh",
            "Energy drawn by the robots' electronics, which are always on",
        ),
        Column("energy_recuperated_kwh", REAL, "kWh", "Energy recovered by braking"),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return the energy in total, per picked unit and for each use, such as driving.

        All values are nan if energy is not modelled.
        """
        counted = run.recorder.energy.final
        if not counted:
            return dict.fromkeys((column.name for column in self.columns), nan)
        kwh = float(counted["used_j"].sum()) / WH / 1e3
        units = run.handled("units_picked")
        return {
            "energy_kwh": kwh,
            "energy_wh_per_unit": ratio(kwh * 1e3, units),
            "energy_kwh_per_1000_units": ratio(kwh * 1e3, units),
            **{
                f"energy_{part}_kwh": float(counted[f"{part}_j"].sum()) / WH / 1e3 for part in PARTS
            },
        }


class Batteries(Measure):
    """Charging and levels of the batteries."""

    columns = (
        Column(
            "energy_charged_kwh",
            REAL,
            "kWh",
            "Energy charged, including by battery swaps; this column and the following ones up "
            "to battery_level_least_share are empty without batteries",
        ),
        Column(
            "charging_share",
            REAL,
            "share",
            "Share of robot time spent charging at chargers or at waypoints with inductive "
            "charging",
        ),
        Column(
            "charge_task_share",
            REAL,
            "share",
            "Share of robot time with a charge task: driving to a charger or swap station, "
            "waiting, and charging or swapping",
            better=LESS,
        ),
        Column("charges", COUNT_OR_EMPTY, "tasks", "Number of charge tasks started"),
        Column(
            "robots_stranded",
            COUNT_OR_EMPTY,
            "robots",
            "Number of times that a robot stopped because its battery level had fallen below the "
            "minimum",
            better=LESS,
        ),
        Column(
            "battery_cycles_mean",
            REAL,
            "cycles",
            "Equivalent full cycles: energy drawn by a robot / capacity of its battery, mean "
            "over robots",
            better=LESS,
        ),
        Column(
            "battery_level_mean_share",
            REAL,
            "share",
            "Mean battery level as a share of the capacity, sampled every minute",
        ),
        Column(
            "battery_level_least_share",
            REAL,
            "share",
            "Lowest battery level of any robot as a share of the capacity, sampled every minute",
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return measures of charging and of battery levels; None or nan without batteries."""
        energy = run.recorder.energy
        batteries, counted, samples = energy.batteries, energy.final, energy.samples
        if batteries is None:
            return {
                column.name: None if column.dtype == COUNT_OR_EMPTY else nan
                for column in self.columns
            }
        robot_time_s = run.layout.robots * run.logs.duration_s
        tasks = run.logs.tasks
        own = tasks[tasks["kind"].isin(run.recorder.charge_kinds)]
        lasted = (own["end_s"] - own["begin_s"].clip(lower=run.start_s)).clip(lower=0.0)
        stranded = [time_s for time_s, _ in batteries.strandings if time_s >= run.start_s]
        return {
            "energy_charged_kwh": float(counted["charged_j"].sum()) / WH / 1e3,
            "charging_share": ratio(float(counted["charging_s"].sum()), robot_time_s),
            "charge_task_share": ratio(float(lasted.sum()), robot_time_s),
            "charges": int((own["begin_s"] >= run.start_s).sum()),
            "robots_stranded": len(stranded),
            "battery_cycles_mean": float(counted["used_j"].mean()) / batteries.capacity_j,
            "battery_level_mean_share": sum(one[2] for one in samples)
            / len(samples)
            / batteries.capacity_j,
            "battery_level_least_share": min(one[3] for one in samples) / batteries.capacity_j,
        }
