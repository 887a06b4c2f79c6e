"""People at the pick stations: every unit takes the same time unless a file says so."""

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
    """Always what the station's layout says."""

    distribution: Literal["constant"] = "constant"


class GammaTime(Block):
    """Gamma; its mean is what the station's layout says."""

    distribution: Literal["gamma"] = "gamma"
    variation: Variation = Field(
        description="coefficient of variation, to 5: beyond, a mean hangs on single picks; "
        "1: exponential"
    )


class LognormalTime(Block):
    """Lognormal; its mean is what the station's layout says."""

    distribution: Literal["lognormal"] = "lognormal"
    variation: Variation = Field(
        description="coefficient of variation, to 5: beyond, a mean hangs on single picks"
    )


class MeasuredTime(Block):
    """Drawn from measured times, each as likely as the others."""

    distribution: Literal["empirical"] = "empirical"
    file: TimesFile = Field(
        description="CSV with a column time_s: s for which a unit kept a picker, relative to the "
        "scenario file; the robot is kept as much longer or shorter as the picker"
    )


UnitTime = Annotated[
    ConstantTime | GammaTime | LognormalTime | MeasuredTime,
    pydantic.Field(discriminator="distribution"),
]


class Learning(Block):
    """Who has picked more units is faster: Wright's curve with De Jong's part that stays."""

    rate: Annotated[float, Field(ge=0.5, le=1)] = Field(
        0.9,
        description="share of the time that can be learned away left after each doubling of the "
        "units picked; no published curve is steeper than 0.5, 1: nobody learns",
    )
    incompressible: Share = Field(
        0.3, description="share of the first unit's time that nobody can learn away"
    )
    units_before: NotNegative = Field(0.0, description="units a picker has picked at time zero")
    standard_units: Annotated[float, Field(ge=1, le=1e9)] = Field(
        1.0, description="which unit takes the station's time, from 1, the first"
    )


class Fatigue(Block):
    """Fatigue grows at work and goes away at rest (Jaber, Givi and Neumann 2013); 0 to 1."""

    per_h: PerHour = Field(
        0.2,
        description="rate at which fatigue grows at work, per hour; to 100: then all is over in "
        "minutes",
    )
    recovery_per_h: PerHour = Field(
        1.0, description="rate at which it goes away at rest, per hour, to 100 likewise"
    )
    waiting_rests: Share = Field(
        1.0,
        description="share of recovery_per_h that holds for a picker who waits at the station; "
        "away from it all does",
    )
    slowdown: Annotated[float, Field(ge=0, le=9)] = Field(
        0.3,
        description="share by which a unit takes longer at fatigue 1, evenly less below; 9: ten "
        "times as long",
    )
    initial: Annotated[float, Field(ge=0, lt=1)] = Field(
        0.0, description="fatigue of everybody at time zero, below 1: nobody is at the end"
    )


class Layers(Block):
    """Pods have layers, each with an equal part of the pod's capacity; some are harder to reach."""

    time_factors: Annotated[Factors, Field(min_length=1, max_length=20)] = Field(
        (1.2, 1.0, 0.9, 1.0, 1.3),
        description="of each layer, from the floor up, what a unit's time is multiplied by (0.1 to "
        "10); a pod has 20 layers at most",
    )
    storing: Literal["emptiest", "golden", "popular"] = Field(
        "emptiest",
        description="where a bundle goes: the layer with most room, the fastest with room, or "
        "popular SKUs into fast layers",
    )


class Faces(Block):
    """Pods have faces; the picker sees one, and another is turned to him at a price."""

    count: Annotated[int, Field(ge=1, le=8)] = Field(
        4, description="faces of a pod, each with an equal part of its capacity; 8 at most"
    )
    turn_face_s: NotNegative = Field(
        5.0,
        description="s that it keeps picker, station and robot until another face is shown; the "
        "first face of a visit costs nothing",
    )


class Errors(Block):
    """Units that are picked wrongly."""

    share: Share = Field(0.001, description="share of the units picked wrongly, when not tired")
    at_full_fatigue: Share | None = Field(
        None, description="share at fatigue 1, evenly less below; default: as share"
    )
    noticed_share: Share = Field(
        1.0, description="share of these noticed at once and put right; others are counted"
    )
    rework_s: NotNegative = Field(
        30.0, description="s that putting right keeps picker, station and robot"
    )

    @pydantic.field_validator("at_full_fatigue")
    @classmethod
    def _grows(cls, value: float | None, info: pydantic.ValidationInfo) -> float | None:
        return None if value is None else not_below(value, info, "share")


class Roster(Block):
    """Who is there when: each shift has pickers of its own, who come again in every cycle."""

    cycle_s: Cycle = DAY_S
    shifts_s: Annotated[Shifts, Field(min_length=1, max_length=100)] = Field(
        description="pairs of first and last s of the cycle, in order; a day has no more than 100"
    )
    pickers: Counts = Field(
        (),
        description="pickers of each shift, at the first pick stations; default: one per pick "
        "station",
    )
    breaks_s: Shifts = Field((), description="pairs of first and last s, when all pickers are away")

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
                raise ValueError(f"[{begin_s:g}, {end_s:g}] must end later, by {cycle_s:g}")
        if any(later[0] < sooner[1] for sooner, later in itertools.pairwise(value)):
            raise ValueError("must be in order and not overlap")
        return value

    @pydantic.field_validator("pickers")
    @classmethod
    def _each_shift(cls, value: tuple[int, ...], info: pydantic.ValidationInfo) -> tuple[int, ...]:
        shifts = info.data.get("shifts_s")
        if value and shifts is not None and len(value) != len(shifts):
            raise ValueError(f"must say it of each of the {len(shifts)} shifts")
        return value


class Pickers(Block):
    """People at the pick stations; see docs/pickers.md.

    With the default values all are alike, always there, and every unit takes the station's time.
    """

    unit_time: UnitTime = Field(ConstantTime(), description="how long a unit keeps a picker")
    speeds: Annotated[Factors, Field(max_length=10_000)] = Field(
        (),
        description="speed of each picker, 0.1 to 10 (nobody differs more); further pickers have "
        "those of the first again; default: drawn as speed_variation says",
    )
    speed_variation: Annotated[float, Field(ge=0, le=1)] = Field(
        0.0,
        description="coefficient of variation of speeds, which are gamma with mean 1; to 1: the "
        "best of a team is seldom twice as fast as the mean",
    )
    learning: Learning | None = Field(None, description="default: nobody learns")
    fatigue: Fatigue | None = Field(None, description="default: nobody tires")
    layers: Layers | None = Field(None, description="default: every place of a pod is alike")
    faces: Faces | None = Field(
        None, description="not beside layers; default: all of a pod can be reached at once"
    )
    errors: Errors | None = Field(None, description="default: nothing is picked wrongly")
    roster: Roster | None = Field(None, description="default: one per pick station, always")

    @pydantic.field_validator("faces")
    @classmethod
    def _layers_or_faces(cls, value: Faces | None, info: pydantic.ValidationInfo) -> Faces | None:
        if value is not None and info.data.get("layers") is not None:
            raise ValueError("must be left out where pods have layers")
        return value

    @pydantic.field_validator("speed_variation")
    @classmethod
    def _one_of_both(cls, value: float, info: pydantic.ValidationInfo) -> float:
        if value and info.data.get("speeds"):
            raise ValueError("must be left out where speeds are given")
        return value
