"""When bundles arrive."""

from __future__ import annotations

from typing import Annotated, Literal

import pydantic
from pydantic import Field

from rmfs.scenario.parameters.calendar import BundleBatches, DownPeriods
from rmfs.scenario.parameters.files import StreamFile
from rmfs.scenario.parameters.rates import TIED_TO, BundleRates, ConstantRate, TiedTo
from rmfs.scenario.quantities import Block, Natural, NotNegative, Positive, Share, not_below


class _Replenishment(Block):
    down: DownPeriods | None = Field(None, description="when no bundles are made; default: never")
    batches: BundleBatches | None = Field(None, description="bundles that come all at once")


class _Drawn(_Replenishment):
    return_share: Share = Field(0.0, description="share of bundles that are returns: one unit each")


class BacklogReplenishment(_Drawn):
    """Bundles are made so that a constant number waits.

    The load is the space of what is stored, on its way into pods and waiting, as a share of the
    pods' capacity.
    """

    mode: Literal["backlog"] = Field("backlog", description="a constant number of bundles waits")
    bundles: Natural = Field(200, description="bundles waiting for a station and a pod")
    pause_by_stock: bool = Field(True, description="whether the two levels below count")
    resume_below_share: NotNegative = Field(
        0.65, description="bundles again once the load (stored, under way, waiting) is less"
    )
    pause_above_share: NotNegative = Field(
        0.85, description="no bundles once the load is a greater share of the pods' capacity"
    )
    load_limit_share: Positive = Field(1.1, description="no bundle that would lift the load above")
    retry_s: Positive = Field(60.0, description="s without bundles after one above that limit")

    @pydantic.field_validator("pause_above_share")
    @classmethod
    def _in_order(cls, value: float, info: pydantic.ValidationInfo) -> float:
        return not_below(value, info, "resume_below_share")


class PoissonReplenishment(_Drawn):
    """Bundles arrive at random times; what finds no room waits."""

    mode: Literal["poisson"] = Field("poisson", description="bundles arrive at random times")
    bundles_per_h: Positive = Field(
        45.0, description="mean rate (with high-low: that of the low periods)"
    )
    per_station: bool = Field(
        True, description="whether all rates are those of one replenishment station"
    )
    tied_to: TiedTo = Field("nothing", description=TIED_TO)
    initial_bundles: Natural = Field(30, description="bundles waiting at time zero")
    profile: BundleRates = Field(ConstantRate(), description="how the rate changes over time")


class NeededReplenishment(_Replenishment):
    """Bundles are made of what is short: wanted by orders, and neither stored nor on its way."""

    mode: Literal["needed"] = Field("needed", description="bundles of what waiting orders lack")
    reorder_below_units: Natural = Field(
        0, description="a SKU is short once fewer units of it are left for further orders"
    )
    bundles: Natural = Field(200, description="bundles waiting for a station and a pod, at most")
    load_limit_share: Positive = Field(
        1.1, description="no bundle that would lift the load (stored, under way, waiting) above"
    )
    retry_s: Positive = Field(60.0, description="s without bundles after one above that limit")


class StreamReplenishment(_Replenishment):
    """Bundles from a file; what finds no room waits."""

    mode: Literal["stream"] = Field("stream", description="bundles come from a file")
    file: StreamFile = Field(
        description=".csv or .parquet with the columns time (s or ISO 8601), order, sku, quantity: "
        "a line is a bundle; or .xitem; relative to the scenario file"
    )
    digest: str | None = Field(
        None, description="SHA-256 of the bundles as `rmfs scenario` prints it; default: any"
    )


Replenishment = Annotated[
    BacklogReplenishment | PoissonReplenishment | NeededReplenishment | StreamReplenishment,
    Field(discriminator="mode"),
]
