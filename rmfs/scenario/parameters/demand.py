"""When orders arrive."""

from __future__ import annotations

from typing import Annotated, Literal

import pydantic
from pydantic import Field

from rmfs.scenario.parameters.calendar import DownPeriods, OrderBatches
from rmfs.scenario.parameters.files import StreamFile
from rmfs.scenario.parameters.rates import TIED_TO, ConstantRate, OrderRates, TiedTo
from rmfs.scenario.quantities import Block, Natural, Positive, Share, not_below


class _Demand(Block):
    down: DownPeriods | None = Field(None, description="when no orders are made; default: never")
    batches: OrderBatches | None = Field(None, description="orders that come all at once")


class BacklogDemand(_Demand):
    """Orders are made so that a constant number waits: only SKUs in stock are ordered.

    Orders that are words do not look at stock.
    """

    mode: Literal["backlog"] = Field("backlog", description="a constant number of orders waits")
    orders: Natural = Field(200, description="orders waiting for a pick station")
    pause_by_stock: bool = Field(True, description="whether the two levels below count")
    pause_below_share: Share = Field(
        0.1, description="no orders once less of the pods' capacity is stored"
    )
    resume_above_share: Share = Field(0.6, description="orders again once more is stored")
    retry_s: Positive = Field(60.0, description="s without orders after one no stock could serve")

    @pydantic.field_validator("resume_above_share")
    @classmethod
    def _in_order(cls, value: float, info: pydantic.ValidationInfo) -> float:
        return not_below(value, info, "pause_below_share")


class PoissonDemand(_Demand):
    """Orders arrive at random times, whatever is in stock; what stock cannot serve waits."""

    mode: Literal["poisson"] = Field("poisson", description="orders arrive at random times")
    orders_per_h: Positive = Field(
        160.0, description="mean rate (with high-low: that of the low periods)"
    )
    per_station: bool = Field(True, description="whether all rates are those of one pick station")
    tied_to: TiedTo = Field("nothing", description=TIED_TO)
    initial_orders: Natural = Field(30, description="orders waiting at time zero")
    profile: OrderRates = Field(ConstantRate(), description="how the rate changes over time")


class StreamDemand(_Demand):
    """Orders from a file; what stock cannot serve waits."""

    mode: Literal["stream"] = Field("stream", description="orders come from a file")
    file: StreamFile = Field(
        description=".csv or .parquet with the columns time (s or ISO 8601), order, sku, quantity, "
        "due (as time; empty: drawn) and others that are kept, or .xitem; relative to the scenario "
        "file"
    )
    digest: str | None = Field(
        None, description="SHA-256 of the orders as `rmfs scenario` prints it; default: any orders"
    )


Demand = Annotated[BacklogDemand | PoissonDemand | StreamDemand, Field(discriminator="mode")]
