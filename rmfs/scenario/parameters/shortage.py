"""What happens to orders that stock cannot serve; by default they wait."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from rmfs.scenario.quantities import Block, Positive


class Shortage(Block):
    """What happens to an order that stock cannot serve.

    Orders that are split, assigned to a station or in a station's pool are not cut or cancelled.
    """

    policy: Literal["wait", "partial", "cancel"] = Field(
        "wait",
        description="wait: until stock arrives; partial: deliver what is in stock and drop the "
        "rest; cancel: give the order up. A partial order with nothing in stock is cancelled",
    )
    after_s: Positive = Field(
        1800.0,
        description="age in s at which an order is checked, and the interval between further "
        "checks",
    )
