"""When replenishment bundles arrive."""

from __future__ import annotations

from typing import Annotated, Literal

import pydantic
from pydantic import Field

from rmfs.scenario.parameters.calendar import BundleBatches, DownPeriods
from rmfs.scenario.parameters.files import StreamFile
from rmfs.scenario.parameters.rates import TIED_TO, BundleRates, ConstantRate, TiedTo
from rmfs.scenario.quantities import Block, Natural, NotNegative, Positive, Share, not_below


class _Replenishment(Block):
    down: DownPeriods | None = Field(
        None, description="when no bundles are generated; default: never"
    )
    batches: BundleBatches | None = Field(
        None, description="bundles that arrive all at once; default: none"
    )


class _Drawn(_Replenishment):
    return_share: Share = Field(
        0.0, description="share of bundles that are returns of a single unit"
    )


class BacklogReplenishment(_Drawn):
    """Keeps a constant number of bundles waiting, except during pauses and down periods.

    Pauses depend on the load: the space taken by stored units, by bundles on their way to pods and
    by waiting bundles, as a share of the pods' capacity.
    """

    mode: Literal["backlog"] = Field("backlog", description="a constant number of bundles waits")
    bundles: Natural = Field(200, description="bundles waiting for a station and a pod")
    pause_by_stock: bool = Field(True, description="whether the two load levels below apply")
    resume_below_share: NotNegative = Field(
        0.65,
        description="resume bundles when the load (stored, under way and waiting) falls below this",
    )
    pause_above_share: NotNegative = Field(
        0.85, description="pause bundles when the load rises above this share of the pods' capacity"
    )
    load_limit_share: Positive = Field(1.1, description="no bundle may lift the load above this")
    retry_s: Positive = Field(
        60.0, description="pause in s after a bundle that would exceed this limit"
    )

    @pydantic.field_validator("pause_above_share")
    @classmethod
    def _in_order(cls, value: float, info: pydantic.ValidationInfo) -> float:
        return not_below(value, info, "resume_below_share")


class PoissonReplenishment(_Drawn):
    """Bundles arrive at random times; a bundle waits if no pod has room for it."""

    mode: Literal["poisson"] = Field("poisson", description="bundles arrive at random times")
    bundles_per_h: Positive = Field(
        45.0, description="mean rate; with a high-low profile, the rate of low periods"
    )
    per_station: bool = Field(True, description="whether rates are per replenishment station")
    tied_to: TiedTo = Field("nothing", description=TIED_TO)
    initial_bundles: Natural = Field(30, description="bundles waiting at time zero")
    profile: BundleRates = Field(ConstantRate(), description="how the rate changes over time")


class NeededReplenishment(_Replenishment):
    """Bundles arrive for SKUs of which too few units are left for further orders.

    The units left of a SKU are its stored units, plus those in bundles that have arrived and are
    not stored yet, minus those that orders still need.
    """

    mode: Literal["needed"] = Field("needed", description="bundles of SKUs that run short")
    reorder_below_units: Natural = Field(
        0, description="a SKU is short when fewer than this many units are left for further orders"
    )
    bundles: Natural = Field(
        200, description="maximum number of bundles waiting for a station and a pod"
    )
    load_limit_share: Positive = Field(
        1.1, description="no bundle may lift the load (stored, under way and waiting) above this"
    )
    retry_s: Positive = Field(
        60.0, description="pause in s after a bundle that would exceed this limit"
    )


class StreamReplenishment(_Replenishment):
    """Bundles come from a file; a bundle waits if no pod has room for it."""

    mode: Literal["stream"] = Field("stream", description="bundles come from a file")
    file: StreamFile = Field(
        description=".csv or .parquet file, relative to the scenario file, with the columns time "
        "(s or ISO 8601), order, sku and quantity, one bundle per line. Or an .xitem file"
    )
    digest: str | None = Field(
        None,
        description="SHA-256 of the bundles, as printed by `rmfs scenario`; default: not checked",
    )


Replenishment = Annotated[
    BacklogReplenishment | PoissonReplenishment | NeededReplenishment | StreamReplenishment,
    Field(discriminator="mode"),
]
