"""Disturbances of a run, such as breakdowns of robots; none by default."""

from __future__ import annotations

from typing import Annotated

import pydantic
from pydantic import Field

from rmfs.scenario.quantities import Block, Natural, NotNegative, Positive, not_below


class _Repeated(Block):
    every_s: float = Field(
        ge=1,
        description="mean of the exponential time between two occurrences, s; at least 1",
    )
    lasting_s: Positive = Field(
        description="mean duration in s; durations are uniform between half and one and a half "
        "times this mean"
    )


class Breakdowns(_Repeated):
    """A robot stops for a while at the end of its current straight run."""


class SlowRobots(_Repeated):
    """A robot drives more slowly for a period, from one standstill to a later one."""

    speed_share: float = Field(
        0.5, gt=0, lt=1, description="speed of a slow robot, as a share of its top speed"
    )


class Closures(_Repeated):
    """An aisle waypoint is closed for a while.

    Waypoints whose closure would cut off a storage location or station are never chosen.
    """


class ChargerFailures(_Repeated):
    """A charger fails for a while; a robot there waits unless the CA controller sends it away."""


class LateMotions(Block):
    """A motion starts later than planned, by a delay that no plan can anticipate."""

    probability: float = Field(
        gt=0, le=1, description="probability of a delay for each straight run of a robot"
    )
    least_s: float = Field(1.0, ge=0, le=3600, description="shortest delay in s; at most an hour")
    most_s: float = Field(
        10.0,
        gt=0,
        le=3600,
        description="longest delay in s, at most an hour; delays are uniform between the two",
    )
    repair: bool = Field(
        True,
        description="whether to replan each robot that has to wait for a late one, alone or "
        "together with it, if the sum of arrival times then decreases",
    )

    @pydantic.field_validator("most_s")
    @classmethod
    def _in_order(cls, value: float, info: pydantic.ValidationInfo) -> float:
        return not_below(value, info, "least_s")


Outage = Annotated[tuple[Natural, NotNegative, Positive], pydantic.Strict(strict=False)]
Outages = Annotated[tuple[Outage, ...], pydantic.Strict(strict=False)]


class Disturbances(Block):
    """Disturbances of a run.

    Elevators are out of service at the times given in `elevators_out`. Every other kind of
    disturbance occurs at random and has its own stream of random numbers, derived from the run's
    seed.
    """

    breakdowns: Breakdowns | None = Field(None, description="robots that stop; default: none")
    slow: SlowRobots | None = Field(None, description="robots that are slow; default: none")
    closures: Closures | None = Field(None, description="closed waypoints; default: none")
    chargers: ChargerFailures | None = Field(None, description="chargers that fail; default: none")
    late_motions: LateMotions | None = Field(
        None, description="motions that begin late; default: none"
    )
    elevators_out: Outages = Field(
        (),
        description="triples of an elevator's index and the start and end, in s, of a period out "
        "of service",
    )

    @pydantic.field_validator("elevators_out")
    @classmethod
    def _in_order(cls, value: tuple[Outage, ...]) -> tuple[Outage, ...]:
        for elevator, begin_s, end_s in value:
            if not begin_s < end_s:
                raise ValueError(
                    f"each must end after it begins: [{elevator}, {begin_s:g}, {end_s:g}] does not"
                )
        return value
