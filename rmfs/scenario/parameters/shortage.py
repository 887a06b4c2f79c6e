"""What becomes of orders that stock cannot serve: they wait unless a file says otherwise."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from rmfs.scenario.quantities import Block, Positive


class Shortage(Block):
    """What becomes of an order that is not at a station yet and that stock cannot serve."""

    policy: Literal["wait", "partial", "cancel"] = Field(
        "wait",
        description="wait: until there is stock; partial: what there is is picked, and the rest is "
        "not delivered; cancel: the order is given up, as is a partial one of which there is "
        "nothing",
    )
    after_s: Positive = Field(
        1800.0,
        description="s from its arrival after which an order is looked at, and again after as many",
    )
