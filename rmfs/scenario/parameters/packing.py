"""Packing of orders after the pick stations; modelled only if a scenario has a table `packing`."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from rmfs.scenario.quantities import Block, Count, NotNegative, Positive


class ToteTravel(Block):
    """Travel of totes from a pick station to the put wall."""

    constant_s: NotNegative = Field(0.0, description="constant part of each trip, s")
    speed_m_s: Positive | None = Field(
        None,
        description="speed in m/s at which a tote, after the constant part, travels the "
        "rectilinear distance from the pick station to the wall; default: only the constant part",
    )
    x_m: float | None = Field(
        None, description="x of the wall, m; default: the mean of the pick stations"
    )
    y_m: float | None = Field(
        None, description="y of the wall, m; default: the mean of the pick stations"
    )
    totes: Count | None = Field(
        None,
        description="maximum number of totes on their way at once, as on a conveyor; default: no "
        "limit",
    )


class Packing(Block):
    """Packers, and a put wall where the parts of split orders are brought together.

    See docs/packing.md. With the default values, transport and packing take no time, and all
    capacities are unlimited.
    """

    slots: Count | None = Field(None, description="slots of the put wall; default: unlimited")
    slot_for: Literal["part", "order"] = Field(
        "part", description="whether each part of an order takes a slot, or all its parts share one"
    )
    by_hand_after_s: Positive = Field(
        900.0,
        description="time in s after which a tote that cannot leave its pick station is carried "
        "to the wall by hand, even if the wall is full",
    )
    bypass: bool = Field(
        True,
        description="whether orders that were never split are packed where they were picked, in "
        "no time, without using the wall or a packer",
    )
    packers: Count | None = Field(None, description="number of packers; default: unlimited")
    order_s: NotNegative = Field(0.0, description="packing time per order, s")
    part_s: NotNegative = Field(0.0, description="additional packing time per part of an order, s")
    variation: NotNegative = Field(
        0.0,
        description="coefficient of variation of packing times, which are gamma distributed; 0: "
        "constant, 1: exponential",
    )
    travel: ToteTravel = Field(ToteTravel(), description="travel from the pick station to the wall")
