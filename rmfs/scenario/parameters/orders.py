"""What orders contain."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import pydantic
from pydantic import Field

from rmfs.scenario.counts import NormalCount, NormalOrListed
from rmfs.scenario.due import Due, PriorityDue
from rmfs.scenario.parameters.shortage import Shortage
from rmfs.scenario.quantities import Block


class Orders(Block):
    """Orders of one or more lines.

    The SKU of a line is drawn by popularity or, from the second line on, by affinity to the SKU of
    the line before (see `Affinity`).
    """

    content: Literal["skus"] = Field("skus", description="each line is drawn from all SKUs")
    lines: NormalOrListed = Field(
        NormalCount(mean=1.0, sd=1.0, min=1, max=4),
        description="number of order lines; no SKU occurs twice in an order",
    )
    units_per_line: NormalOrListed = Field(
        NormalCount(mean=1.0, sd=0.3, min=1, max=3), description="number of units of an order line"
    )
    due: Due = Field(PriorityDue(), description="when an order is due")
    shortage: Shortage = Field(
        Shortage(), description="what happens to orders that stock cannot serve"
    )

    @pydantic.field_validator("lines", "units_per_line", mode="before")
    @classmethod
    def _default_kind(cls, value: Any) -> Any:
        """Assume a normal distribution if a table does not specify one."""
        return {"distribution": "normal", **value} if isinstance(value, dict) else value


class WordOrders(Block):
    """Orders that are words of coloured letters; equal letters of one colour form one line."""

    content: Literal["words"] = Field(
        "words", description="each order is a word in coloured letters"
    )
    units_per_letter: NormalCount = Field(
        NormalCount(mean=1.0, sd=0.3, min=1, max=3),
        description="number of units of a letter; equal letters of one colour are added up",
    )
    due: Due = Field(PriorityDue(), description="when an order is due")
    shortage: Shortage = Field(
        Shortage(), description="what happens to orders that stock cannot serve"
    )


AnyOrders = Annotated[Orders | WordOrders, Field(discriminator="content")]


def not_above_skus(lines: int, skus: int) -> None:
    """Check that an order with `lines` lines can have a different SKU in each line.

    Raises
    ------
    ValueError
        If there are too few SKUs.
    """
    if lines > skus:
        raise ValueError(f"lines.max = {lines} exceeds the {skus} SKUs (no SKU twice in an order)")
