"""What robots drew from their batteries; empty cells where energy is not counted."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import LESS, REAL, Column
from rmfs.measure.energy import WH
from rmfs.measure.measures.reckoning import ratio

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun

PARTS = ("drive", "turn", "lift", "standby", "recuperated")


class Energy(Measure):
    """Energy of the fleet."""

    columns = (
        Column(
            "energy_kwh",
            REAL,
            "kWh",
            "Drawn by all robots, less what braking gave back; empty where energy is not counted",
            better=LESS,
        ),
        Column("energy_wh_per_unit", REAL, "Wh", "energy_kwh / units_picked", better=LESS),
        Column(
            "energy_kwh_per_1000_units",
            REAL,
            "kWh",
            "energy_kwh per 1,000 picked units",
            better=LESS,
        ),
        Column("energy_drive_kwh", REAL, "kWh", "Drawn for driving"),
        Column("energy_turn_kwh", REAL, "kWh", "Drawn for turning on the spot"),
        Column("energy_lift_kwh", REAL, "kWh", "Drawn for lifting pods"),
        Column("energy_standby_kwh", REAL, "kWh", "Drawn by electronics, all the time"),
        Column("energy_recuperated_kwh", REAL, "kWh", "Given back by braking"),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Add up what traffic counted."""
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
