"""What an order contains."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import pydantic
from pydantic import Field

from rmfs.scenario.counts import NormalCount, NormalOrListed
from rmfs.scenario.due import Due, PriorityDue
from rmfs.scenario.parameters.shortage import Shortage
from rmfs.scenario.quantities import Block


class Orders(Block):
    """Orders with a number of lines, each for a SKU drawn by popularity or affinity."""

    content: Literal["skus"] = Field("skus", description="each line is drawn from all SKUs")
    lines: NormalOrListed = Field(
        NormalCount(mean=1.0, sd=1.0, min=1, max=4),
        description="lines of an order, each with a SKU of its own",
    )
    units_per_line: NormalOrListed = Field(
        NormalCount(mean=1.0, sd=0.3, min=1, max=3), description="units of an order line"
    )
    due: Due = Field(PriorityDue(), description="when an order is due")
    shortage: Shortage = Field(
        Shortage(), description="what becomes of orders that stock cannot serve"
    )

    @pydantic.field_validator("lines", "units_per_line", mode="before")
    @classmethod
    def _default_kind(cls, value: Any) -> Any:
        """Let a table that does not name its distribution be normal."""
        return {"distribution": "normal", **value} if isinstance(value, dict) else value


class WordOrders(Block):
    """Orders that are words: a line for each letter in its colour."""

    content: Literal["words"] = Field("words", description="each order is a word in colours")
    units_per_letter: NormalCount = Field(
        NormalCount(mean=1.0, sd=0.3, min=1, max=3),
        description="units of a letter; equal letters of one colour are added up",
    )
    due: Due = Field(PriorityDue(), description="when an order is due")
    shortage: Shortage = Field(
        Shortage(), description="what becomes of orders that stock cannot serve"
    )


AnyOrders = Annotated[Orders | WordOrders, Field(discriminator="content")]


def not_above_skus(lines: int, skus: int) -> None:
    """Check that an order of so many lines can have a SKU of its own on each.

    Raises
    ------
    ValueError
        If there are too few SKUs.
    """
    if lines > skus:
        raise ValueError(f"lines.max = {lines} exceeds the {skus} SKUs (no SKU twice in an order)")
