"""When orders arrive."""

from __future__ import annotations

from typing import Annotated, Literal

import pydantic
from pydantic import Field

from rmfs.scenario.parameters.calendar import DownPeriods, OrderBatches
from rmfs.scenario.parameters.files import StreamFile
from rmfs.scenario.parameters.rates import TIED_TO, ConstantRate, OrderRates, TiedTo
from rmfs.scenario.quantities import Block, Positive, Share, Waiting, not_below


class _Demand(Block):
    down: DownPeriods | None = Field(
        None, description="when no orders are generated; default: never"
    )
    batches: OrderBatches | None = Field(
        None, description="orders that arrive all at once; default: none"
    )


class BacklogDemand(_Demand):
    """Keeps a constant number of orders waiting, except during pauses and down periods.

    Orders contain only units that are in stock and not needed by earlier orders. This does not
    apply to orders that are words (`WordOrders`), which are drawn whatever is in stock.
    """

    mode: Literal["backlog"] = Field("backlog", description="a constant number of orders waits")
    orders: Waiting = Field(200, description="orders waiting for a pick station")
    pause_by_stock: bool = Field(True, description="whether the two stock levels below apply")
    pause_below_share: Share = Field(
        0.1, description="pause orders when the stored share of the pods' capacity falls below this"
    )
    resume_above_share: Share = Field(
        0.6, description="resume orders when the stored share rises above this"
    )
    retry_s: Positive = Field(
        60.0, description="pause in s after an order that stock could not serve"
    )

    @pydantic.field_validator("resume_above_share")
    @classmethod
    def _in_order(cls, value: float, info: pydantic.ValidationInfo) -> float:
        return not_below(value, info, "pause_below_share")


class PoissonDemand(_Demand):
    """Orders arrive at random times, whatever is in stock.

    By default, an order waits if stock cannot serve it (see `Shortage`).
    """

    mode: Literal["poisson"] = Field("poisson", description="orders arrive at random times")
    orders_per_h: Positive = Field(
        160.0, description="mean rate; with a high-low profile, the rate of low periods"
    )
    per_station: bool = Field(True, description="whether rates are per pick station")
    tied_to: TiedTo = Field("nothing", description=TIED_TO)
    initial_orders: Waiting = Field(30, description="orders waiting at time zero")
    profile: OrderRates = Field(ConstantRate(), description="how the rate changes over time")


class StreamDemand(_Demand):
    """Orders come from a file and, by default, wait if stock cannot serve them (see `Shortage`)."""

    mode: Literal["stream"] = Field("stream", description="orders come from a file")
    file: StreamFile = Field(
        description=".csv or .parquet file, relative to the scenario file, with the columns time "
        "(s or ISO 8601), order, sku, quantity and due (a time; drawn where empty); other "
        "columns are kept. Or an .xitem file"
    )
    digest: str | None = Field(
        None,
        description="SHA-256 of the orders, as printed by `rmfs scenario`; default: not checked",
    )


Demand = Annotated[BacklogDemand | PoissonDemand | StreamDemand, Field(discriminator="mode")]
