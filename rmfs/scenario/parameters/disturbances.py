"""What goes wrong while a warehouse runs: nothing, unless a file says so."""

from __future__ import annotations

from typing import Annotated

import pydantic
from pydantic import Field

from rmfs.scenario.quantities import Block, Natural, NotNegative, Positive, not_below


class _Repeated(Block):
    every_s: float = Field(ge=1, description="mean s from one to the next, exponential; 1 at least")
    lasting_s: Positive = Field(
        description="mean s it lasts, drawn evenly from half of it to one and a half"
    )


class Breakdowns(_Repeated):
    """A robot stands still for a while where its present straight run ends."""


class SlowRobots(_Repeated):
    """A robot drives slower for a while, from and until a moment at which it stands still."""

    speed_share: float = Field(0.5, gt=0, lt=1, description="of its top speed")


class Closures(_Repeated):
    """A waypoint of the aisles that everything can do without is closed for a while."""


class ChargerFailures(_Repeated):
    """A plug-in place gives nothing for a while; the robot there waits, or is called away."""


class LateMotions(Block):
    """A motion begins later than planned; it is drawn just before, and no plan knows of it."""

    probability: float = Field(gt=0, le=1, description="of each straight run of a robot")
    least_s: float = Field(1.0, ge=0, le=3600, description="shortest delay; at most an hour")
    most_s: float = Field(
        10.0, gt=0, le=3600, description="longest delay; all between are equally likely"
    )
    repair: bool = Field(
        True, description="plan those who wait behind again, alone or in front, if that is better"
    )

    @pydantic.field_validator("most_s")
    @classmethod
    def _in_order(cls, value: float, info: pydantic.ValidationInfo) -> float:
        return not_below(value, info, "least_s")


Outage = Annotated[tuple[Natural, NotNegative, Positive], pydantic.Strict(strict=False)]
Outages = Annotated[tuple[Outage, ...], pydantic.Strict(strict=False)]


class Disturbances(Block):
    """Each kind has random times of its own, of the run's seed."""

    breakdowns: Breakdowns | None = Field(None, description="robots that stop; default: none")
    slow: SlowRobots | None = Field(None, description="robots that are slow; default: none")
    closures: Closures | None = Field(None, description="closed waypoints; default: none")
    chargers: ChargerFailures | None = Field(
        None, description="plug-in places that fail; default: none"
    )
    late_motions: LateMotions | None = Field(
        None, description="motions that begin late; default: none"
    )
    elevators_out: Outages = Field(
        (), description="triples of an elevator's index and the first and last s it is out of use"
    )

    @pydantic.field_validator("elevators_out")
    @classmethod
    def _in_order(cls, value: tuple[Outage, ...]) -> tuple[Outage, ...]:
        for elevator, begin_s, end_s in value:
            if not begin_s < end_s:
                raise ValueError(
                    f"must end after they begin: [{elevator}, {begin_s:g}, {end_s:g}] does not"
                )
        return value
