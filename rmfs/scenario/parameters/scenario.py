"""The scenario as a whole."""

from __future__ import annotations

from datetime import date, datetime
from typing import Any, Literal, Self

import pydantic
from pydantic import Field

from rmfs.scenario.parameters.demand import BacklogDemand, Demand, StreamDemand
from rmfs.scenario.parameters.disturbances import Disturbances
from rmfs.scenario.parameters.energy import Energy
from rmfs.scenario.parameters.orders import AnyOrders, Orders, WordOrders, not_above_skus
from rmfs.scenario.parameters.packing import Packing
from rmfs.scenario.parameters.pickers import Pickers
from rmfs.scenario.parameters.replenishment import BacklogReplenishment, Replenishment
from rmfs.scenario.parameters.skus import GeneratedSkus, LetterSkus, Skus
from rmfs.scenario.quantities import Block, NotNegative, Positive, Share
from rmfs.scenario.streams.times import midnight


class Stock(Block):
    """Contents of the pods at time zero."""

    initial_share: Share = Field(0.7, description="share of the pods' capacity filled at time zero")
    order_cover: NotNegative = Field(
        0.0,
        description="first store, of each SKU, whole bundles with at least this multiple of the "
        "units ordered in the file of orders during the run; needs demand.mode = stream",
    )


class Scenario(Block):
    """SKUs, stock, demand and so on: all inputs of a run except layout, controllers and seed."""

    format: Literal["rmfs-scenario/1"] = Field(description="version of this format")
    name: str = Field(min_length=1, description="name shown in results")
    description: str = Field("", description="what the scenario is for")
    duration_s: Positive = Field(description="measured time after the warm-up, s")
    warmup_s: NotNegative = Field(3600.0, description="simulated time before measuring begins, s")
    start: str | None = Field(
        None,
        description="date and time of time zero, such as 2026-03-01T08:00:00, for files with ISO "
        "8601 times; default: time_of_day_s after midnight of the day of their first row",
    )
    time_of_day_s: NotNegative = Field(
        0.0,
        description="time in s by which all cycles (profiles, batches, down periods, shifts) "
        "have advanced at time zero; default: the time of day of start",
    )
    skus: Skus = Field(GeneratedSkus(), description="the SKUs, and how often each is ordered")
    orders: AnyOrders = Field(Orders(), description="what an order contains")
    stock: Stock = Field(Stock(), description="what the pods hold at time zero")
    demand: Demand = Field(BacklogDemand(), description="when orders arrive")
    replenishment: Replenishment = Field(BacklogReplenishment(), description="when bundles arrive")

    disturbances: Disturbances = Field(Disturbances(), description="what goes wrong in the run")
    energy: Energy | None = Field(
        None, description="energy use and batteries of robots; default: not modelled"
    )
    packing: Packing | None = Field(
        None,
        description="packing after the pick stations; default: orders are complete when picked",
    )
    pickers: Pickers | None = Field(
        None, description="pickers at the pick stations; default: every unit takes the same time"
    )

    @pydantic.field_validator("start", mode="before")
    @classmethod
    def _moment(cls, value: Any) -> Any:
        """Return the date and time as text; TOML dates and times are accepted as well."""
        if isinstance(value, str):
            try:
                value = datetime.fromisoformat(value)
            except ValueError:
                raise ValueError("must be a time such as 2026-03-01T08:00:00") from None
        if isinstance(value, date) and not isinstance(value, datetime):
            value = datetime(value.year, value.month, value.day)
        return value.isoformat() if isinstance(value, datetime) else value

    @pydantic.model_validator(mode="after")
    def _clock(self) -> Self:
        """Set `time_of_day_s` to the time of day of `start`."""
        if self.start is None:
            return self
        moment = datetime.fromisoformat(self.start)
        shown_s = (moment - midnight(moment)).total_seconds()
        if "time_of_day_s" in self.model_fields_set and self.time_of_day_s != shown_s:
            raise ValueError(f"time_of_day_s must be {shown_s:g} to match start, or be left out")
        if self.time_of_day_s != shown_s:
            object.__setattr__(self, "time_of_day_s", shown_s)
        return self

    @pydantic.field_validator("orders", "demand", "replenishment", mode="before")
    @classmethod
    def _default_kind(cls, value: Any, info: pydantic.ValidationInfo) -> Any:
        """Assume the default kind if a table does not specify its kind."""
        key, kind = ("content", "skus") if info.field_name == "orders" else ("mode", "backlog")
        return {key: kind, **value} if isinstance(value, dict) else value

    @pydantic.field_validator("demand")
    @classmethod
    def _covers(cls, value: Demand, info: pydantic.ValidationInfo) -> Demand:
        stock = info.data.get("stock")
        if stock is not None and stock.order_cover and not isinstance(value, StreamDemand):
            raise ValueError('must have mode "stream": stock.order_cover needs a file of orders')
        return value

    @pydantic.field_validator("orders")
    @classmethod
    def _fits_skus(cls, value: AnyOrders, info: pydantic.ValidationInfo) -> AnyOrders:
        skus = info.data.get("skus")
        if isinstance(value, Orders) and isinstance(skus, GeneratedSkus):
            not_above_skus(value.lines.max, skus.count)
        if skus is not None and isinstance(value, WordOrders) != isinstance(skus, LetterSkus):
            raise ValueError('content = "words" and skus.words must be used together')
        return value
