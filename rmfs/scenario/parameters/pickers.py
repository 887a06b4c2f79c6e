"""Pickers at the pick stations.

If a scenario has no table `pickers`, every unit takes the time given in the layout.
"""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Annotated, Literal

import pydantic
from pydantic import Field

from rmfs.scenario.parameters.calendar import DAY_S, Cycle, Period
from rmfs.scenario.parameters.files import existing
from rmfs.scenario.quantities import Block, Count, NotNegative, Share, not_below

Variation = Annotated[float, Field(gt=0, le=5)]
Factor = Annotated[float, Field(ge=0.1, le=10)]
PerHour = Annotated[float, Field(ge=0, le=100)]
Factors = Annotated[tuple[Factor, ...], pydantic.Strict(strict=False)]
Shifts = Annotated[tuple[Period, ...], pydantic.Strict(strict=False)]
Counts = Annotated[tuple[Count, ...], pydantic.Strict(strict=False)]
TimesFile = Annotated[Path, pydantic.Strict(strict=False), existing(".csv")]


class ConstantTime(Block):
    """Every unit takes the time that the layout gives for the station."""

    distribution: Literal["constant"] = "constant"


class GammaTime(Block):
    """Gamma distribution; its mean is the time that the layout gives for the station."""

    distribution: Literal["gamma"] = "gamma"
    variation: Variation = Field(
        description="coefficient of variation, at most 5, since beyond that single picks "
        "dominate the mean; 1: exponential"
    )


class LognormalTime(Block):
    """Lognormal distribution; its mean is the time that the layout gives for the station."""

    distribution: Literal["lognormal"] = "lognormal"
    variation: Variation = Field(
        description="coefficient of variation, at most 5, since beyond that single picks "
        "dominate the mean"
    )


class MeasuredTime(Block):
    """The time of each unit is drawn from measured times, which are equally likely."""

    distribution: Literal["empirical"] = "empirical"
    file: TimesFile = Field(
        description="CSV file, relative to the scenario file, with a column time_s: picking "
        "times of single units in s. The time for which a unit occupies the robot changes in the "
        "same proportion"
    )


UnitTime = Annotated[
    ConstantTime | GammaTime | LognormalTime | MeasuredTime,
    pydantic.Field(discriminator="distribution"),
]


class Learning(Block):
    """Pickers get faster with each unit, by the learning curve of De Jong.

    Learning does not reduce the share `incompressible` of the first unit's time. If this share is
    0, the curve is Wright's.
    """

    rate: Annotated[float, Field(ge=0.5, le=1)] = Field(
        0.9,
        description="share of the compressible time that remains after each doubling of the "
        "units picked; no published curve is steeper than 0.5; 1: no learning",
    )
    incompressible: Share = Field(
        0.3, description="share of the first unit's time that learning cannot reduce"
    )
    units_before: NotNegative = Field(
        0.0, description="units that each picker has already picked at time zero"
    )
    standard_units: Annotated[float, Field(ge=1, le=1e9)] = Field(
        1.0, description="number of the unit that takes the station's time; 1: the first"
    )


class Fatigue(Block):
    """Fatigue, from 0 to 1, grows at work and falls at rest (Jaber, Givi and Neumann 2013)."""

    per_h: PerHour = Field(
        0.2,
        description="rate at which fatigue grows at work, per hour; at most 100, which exhausts "
        "a picker in minutes",
    )
    recovery_per_h: PerHour = Field(
        1.0, description="rate of recovery at rest, per hour; at most 100"
    )
    waiting_rests: Share = Field(
        1.0,
        description="share of recovery_per_h that applies while a picker waits at the station; "
        "the full rate applies away from it",
    )
    slowdown: Annotated[float, Field(ge=0, le=9)] = Field(
        0.3,
        description="share by which fatigue 1 lengthens the time of a unit; less fatigue lengthens "
        "it in proportion; 9: ten times as long",
    )
    initial: Annotated[float, Field(ge=0, lt=1)] = Field(
        0.0, description="fatigue of every picker at time zero; below 1"
    )


class Layers(Block):
    """Pods have layers of equal capacity, some harder to reach than others."""

    time_factors: Annotated[Factors, Field(min_length=1, max_length=20)] = Field(
        (1.2, 1.0, 0.9, 1.0, 1.3),
        description="factor on the time of a unit for each layer, from the bottom up (0.1 to "
        "10); at most 20 layers",
    )
    storing: Literal["emptiest", "golden", "popular"] = Field(
        "emptiest",
        description="where a bundle is stored: in the emptiest layer, in the fastest layer with "
        "room, or popular SKUs in fast layers",
    )


class Faces(Block):
    """Pods have faces: the picker sees one face at a time, and changing faces takes time."""

    count: Annotated[int, Field(ge=1, le=8)] = Field(
        4, description="faces of a pod, each with an equal part of its capacity; at most 8"
    )
    turn_face_s: NotNegative = Field(
        5.0,
        description="time in s that showing another face occupies the picker, station and robot; "
        "the first face of a visit is free",
    )


class Errors(Block):
    """Picking errors."""

    share: Share = Field(0.001, description="share of units picked wrongly without fatigue")
    at_full_fatigue: Share | None = Field(
        None,
        description="share of units picked wrongly at fatigue 1, linear in between; default: the "
        "same as share",
    )
    noticed_share: Share = Field(
        1.0,
        description="share of errors that are noticed and corrected at once; the others are "
        "counted",
    )
    rework_s: NotNegative = Field(
        30.0,
        description="time in s that correcting an error occupies the picker, station and robot",
    )

    @pydantic.field_validator("at_full_fatigue")
    @classmethod
    def _grows(cls, value: float | None, info: pydantic.ValidationInfo) -> float | None:
        return None if value is None else not_below(value, info, "share")


class Roster(Block):
    """Shifts and breaks in a cycle, usually a day.

    Each shift has its own pickers, who are the same in every cycle.
    """

    cycle_s: Cycle = DAY_S
    shifts_s: Annotated[Shifts, Field(min_length=1, max_length=100)] = Field(
        description="shifts as pairs of start and end, in s of the cycle, in order; at most 100"
    )
    pickers: Counts = Field(
        (),
        description="number of pickers in each shift, at the first pick stations; default: one "
        "per pick station",
    )
    breaks_s: Shifts = Field(
        (), description="breaks of all pickers as pairs of start and end, in s of the cycle"
    )

    @pydantic.field_validator("shifts_s", "breaks_s")
    @classmethod
    def _in_order(
        cls, value: tuple[tuple[float, float], ...], info: pydantic.ValidationInfo
    ) -> tuple[tuple[float, float], ...]:
        cycle_s = info.data.get("cycle_s")
        if cycle_s is None:
            return value
        for begin_s, end_s in value:
            if not begin_s < end_s <= cycle_s:
                raise ValueError(
                    f"[{begin_s:g}, {end_s:g}] must end after its start, by {cycle_s:g}"
                )
        if any(later[0] < sooner[1] for sooner, later in itertools.pairwise(value)):
            raise ValueError("must be in order and must not overlap")
        return value

    @pydantic.field_validator("pickers")
    @classmethod
    def _each_shift(cls, value: tuple[int, ...], info: pydantic.ValidationInfo) -> tuple[int, ...]:
        shifts = info.data.get("shifts_s")
        if value and shifts is not None and len(value) != len(shifts):
            raise ValueError(f"must have one number for each of the {len(shifts)} shifts")
        return value


class Pickers(Block):
    """Pickers at the pick stations; see docs/pickers.md.

    With the default values all pickers are alike and always present, and every unit takes the time
    that the layout gives for the station.
    """

    unit_time: UnitTime = Field(ConstantTime(), description="how long a unit occupies a picker")
    speeds: Annotated[Factors, Field(max_length=10_000)] = Field(
        (),
        description="speed of each picker, 0.1 to 10; if there are more pickers, the values "
        "repeat; default: drawn with speed_variation",
    )
    speed_variation: Annotated[float, Field(ge=0, le=1)] = Field(
        0.0,
        description="coefficient of variation of the speeds, which are gamma distributed with "
        "mean 1; at most 1",
    )
    learning: Learning | None = Field(None, description="learning of pickers; default: none")
    fatigue: Fatigue | None = Field(None, description="fatigue of pickers; default: none")
    layers: Layers | None = Field(
        None, description="layers of pods; default: all places of a pod are alike"
    )
    faces: Faces | None = Field(
        None,
        description="faces of pods, not together with layers; default: all of a pod can be "
        "reached at once",
    )
    errors: Errors | None = Field(None, description="picking errors; default: none")
    roster: Roster | None = Field(
        None, description="shifts; default: one picker per pick station, always present"
    )

    @pydantic.field_validator("faces")
    @classmethod
    def _layers_or_faces(cls, value: Faces | None, info: pydantic.ValidationInfo) -> Faces | None:
        if value is not None and info.data.get("layers") is not None:
            raise ValueError("must be left out where pods have layers: use one of the two")
        return value

    @pydantic.field_validator("speed_variation")
    @classmethod
    def _one_of_both(cls, value: float, info: pydantic.ValidationInfo) -> float:
        if value and info.data.get("speeds"):
            raise ValueError("must be left out where speeds are given")
        return value
