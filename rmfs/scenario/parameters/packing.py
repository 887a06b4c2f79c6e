"""What becomes of orders after the pick stations: nothing is asked unless a file says so."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from rmfs.scenario.quantities import Block, Count, NotNegative, Positive


class ToteTravel(Block):
    """How long totes take from a pick station to the put wall."""

    constant_s: NotNegative = Field(0.0, description="s of every way")
    speed_m_s: Positive | None = Field(
        None,
        description="m/s, besides, over the distance along the two axes from the pick station to "
        "the wall; default: distance does not count",
    )
    x_m: float | None = Field(
        None, description="m, where the wall is; default: in the middle of the pick stations"
    )
    y_m: float | None = Field(None, description="m, likewise")
    totes: Count | None = Field(
        None,
        description="totes that may be on their way at once, as on a conveyor; default: any number",
    )


class Packing(Block):
    """A put wall where the parts of split orders come together, and packers; see docs/packing.md.

    With the default values nothing takes time and there is room for everything.
    """

    slots: Count | None = Field(
        None, description="slots of the put wall; default: as many as are needed"
    )
    slot_for: Literal["part", "order"] = Field(
        "part", description="whether each part of an order takes a slot, or all of them one"
    )
    by_hand_after_s: Positive = Field(
        900.0,
        description="s after which a tote that its pick station cannot let go is carried to the "
        "wall by hand, whether there is room or not",
    )
    bypass: bool = Field(
        True,
        description="whether an order that was never split is packed where it was picked, in no "
        "time, and needs neither wall nor packer",
    )
    packers: Count | None = Field(None, description="packers; default: as many as are needed")
    order_s: NotNegative = Field(0.0, description="s a packer takes for an order ...")
    part_s: NotNegative = Field(0.0, description="... and for each of its parts besides")
    variation: NotNegative = Field(
        0.0,
        description="coefficient of variation of a packer's times, which are gamma; 0: always "
        "alike, 1: exponential",
    )
    travel: ToteTravel = Field(ToteTravel(), description="the way from pick station to wall")
