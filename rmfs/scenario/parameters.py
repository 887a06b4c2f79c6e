"""What a scenario file says.

Names and default values follow the settings of RAWSim-O (its file format .xsett), in plain words
and with the unit as suffix. A `Field` description is the one place where a parameter is explained:
`rmfs scenario show` writes it into the file as a comment.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import pydantic
from pydantic import Field

from rmfs.scenario.counts import Counts, NormalCount, UniformCount
from rmfs.scenario.distributions import Gamma, Popularity, Space, Uniform
from rmfs.scenario.due import Due, PriorityDue
from rmfs.scenario.quantities import (
    Block,
    Count,
    Natural,
    NotNegative,
    Positive,
    Share,
    not_below,
)

OWN_SEED = "seed of the SKUs, not of the run: runs with different seeds share their SKUs"


class _Sizes(Block):
    seed: Natural = Field(0, description=OWN_SEED)
    space_per_unit: Space = Field(
        Uniform(min=2.0, max=8.0), description="space units that one unit of a SKU takes"
    )
    bundle_units: Counts = Field(
        UniformCount(min=4, max=12), description="units in a replenishment bundle of a SKU"
    )


class GeneratedSkus(_Sizes):
    """SKUs drawn from distributions.

    Their seed belongs to the scenario, as a published SKU file would: runs with different seeds
    share their SKUs and differ in stock and demand.
    """

    count: Count = Field(1000, description="number of SKUs")
    popularity: Popularity = Field(
        Gamma(shape=1.0, scale=2.0, min=1.0),
        description="relative weight with which a SKU is ordered and replenished",
    )


class SkuFile(_Sizes):
    """SKUs from a RAWSim-O file (.xgenc).

    Popularity and affinity come from the file; space and bundle sizes too, unless it has none:
    then they are drawn as said here.
    """

    file: Path = Field(description=".xgenc file, relative to the scenario file", strict=False)

    @pydantic.field_validator("file")
    @classmethod
    def _exists(cls, value: Path) -> Path:
        if not value.is_file():
            raise ValueError("no such file")
        return value


def _sku_source(value: Any) -> str:
    """Tell which of the two tables of SKUs is meant."""
    named = "file" in value if isinstance(value, dict) else isinstance(value, SkuFile)
    return SkuFile.__name__ if named else GeneratedSkus.__name__


Skus = Annotated[
    Annotated[GeneratedSkus, pydantic.Tag("GeneratedSkus")]
    | Annotated[SkuFile, pydantic.Tag("SkuFile")],
    pydantic.Discriminator(_sku_source),
]


class Orders(Block):
    """What an order contains."""

    lines: NormalCount = Field(
        NormalCount(mean=1.0, sd=1.0, min=1, max=4),
        description="lines of an order, each with a SKU of its own",
    )
    units_per_line: NormalCount = Field(
        NormalCount(mean=1.0, sd=0.3, min=1, max=3), description="units of an order line"
    )
    due: Due = Field(PriorityDue(), description="when an order is due")


class Stock(Block):
    """What the pods hold at time zero."""

    initial_share: Share = Field(0.7, description="share of the pods' capacity filled at time zero")


class BacklogDemand(Block):
    """Orders are made so that a constant number waits: only SKUs in stock are ordered."""

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


class BacklogReplenishment(Block):
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


class Scenario(Block):
    """All that a run is asked to do, apart from the warehouse and its controllers."""

    format: Literal["rmfs-scenario/1"] = Field(description="version of this format")
    name: str = Field(min_length=1, description="name shown in results")
    description: str = Field("", description="what the scenario is for")
    duration_s: Positive = Field(description="s, measured, after the warm-up")
    warmup_s: NotNegative = Field(3600.0, description="s simulated first and not measured")
    skus: Skus = Field(GeneratedSkus(), description="the SKUs, and how often each is ordered")
    orders: Orders = Field(Orders(), description="what an order contains")
    stock: Stock = Field(Stock(), description="what the pods hold at time zero")
    demand: BacklogDemand = Field(BacklogDemand(), description="when orders arrive")
    replenishment: BacklogReplenishment = Field(
        BacklogReplenishment(), description="when bundles arrive"
    )

    @pydantic.field_validator("orders")
    @classmethod
    def _enough_skus(cls, value: Orders, info: pydantic.ValidationInfo) -> Orders:
        skus = info.data.get("skus")
        if isinstance(skus, GeneratedSkus):
            not_above_skus(value.lines.max, skus.count)
        return value


def not_above_skus(lines: int, skus: int) -> None:
    """Check that an order of so many lines can have a SKU of its own on each.

    Raises
    ------
    ValueError
        If there are too few SKUs.
    """
    if lines > skus:
        raise ValueError(f"lines.max = {lines} exceeds the {skus} SKUs (no SKU twice in an order)")
