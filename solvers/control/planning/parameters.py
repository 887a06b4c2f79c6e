"""Parameters of TA planning."""

from __future__ import annotations

from typing import Annotated, Literal

import pydantic

from rmfs.control.ta.rest import RestRule
from rmfs.solvers.control.parameters import SearchParameters

NotNegative = Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)]
Count = Annotated[int, pydantic.Field(ge=1)]

STEPS_PER_STATION = 75
"""Default of `steps`, per pick station of the site."""


class PlanningParameters(SearchParameters):
    """Parameters of TA planning."""

    method: Literal["lns", "greedy", "cp_sat"] = "lns"
    """Solution method: `lns` (large neighbourhood search), `cp_sat` (exact, for very small sites),
    or `greedy`, the start rule of the other two."""
    split: bool = False
    """Whether the lines of an order may be assigned separately, to different stations or at
    different times."""
    split_orders: Annotated[int, pydantic.Field(ge=0)] | None = None
    """With `split`, maximum number of orders that are split at the same time. By default, as many
    as the put wall holds, or any number without a put wall. If a number is given, it applies
    instead of the space on the put wall."""
    visits: Annotated[int, pydantic.Field(ge=1, le=32)] = 6
    """Maximum number of new visits planned per station, in addition to the visits of pods under
    way."""
    stations: Count = 64
    """Maximum number of pick stations planned at a time. If there are more, those with the least
    work under way are planned, and the plans of the others are kept."""
    steps: Annotated[int, pydantic.Field(ge=0)] | None = None
    """Number of search steps per plan and planned station. Default: 75 times the number of pick
    stations of the site, as plans of many stations take longer to improve."""
    buffer_s: NotNegative = 1.0
    """Minimum time, in seconds, between two questions to the optimiser, so that one question covers
    several decisions."""
    horizon_s: NotNegative = 60.0
    """A station gets another pod when the pods under way to it bring less than this number of
    seconds of work."""
    unit_s: NotNegative = 10.0
    """Value of serving a unit, in seconds of robot time."""
    order_s: NotNegative = 5.0
    """Value of completing an order, in seconds of robot time."""
    age_reward: NotNegative = 0.002
    """Additional value of completing an order that has no slot yet, in seconds of robot time, per
    second that the order has waited."""
    late_s: NotNegative = 0.0
    """Additional value of completing an order that is due, in seconds of robot time, times the
    weight of the order's class. If t seconds are left until the due time, the value is multiplied
    by exp(-t / `late_within_s`). As later visits count less (`decay`), postponing the order costs
    part of this value (apparent tardiness cost, Vepsalainen and Morton 1987). 0: due times are
    ignored."""
    late_within_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 300.0
    """If a line is served this number of seconds before its due time, the value `late_s` counts 1/e
    times as much as at the due time. This number should be about as long as the time from a plan to
    its last visit."""
    open_s: NotNegative = 60.0
    """Additional value of serving a line whose order already has a slot, in seconds of robot time.
    This value keeps plans stable and frees slots."""
    visit_s: NotNegative = 100.0
    """Value of a visit, in seconds of robot time, regardless of what is served: a visit keeps the
    station busy."""
    balance: NotNegative = 0.0
    """Additional cost of a visit, in seconds of robot time, for each second by which the work of
    the visited station exceeds that of the station with the least work. This spreads work over
    stations and their pickers."""
    decay: Annotated[float, pydantic.Field(gt=0, le=1)] = 0.9
    """Weight of each visit to a station, relative to the previous visit to the station."""
    expected_s: NotNegative = 0.0
    """Horizon, in seconds, of the future orders considered in a plan, which are drawn from past
    orders. Future orders raise the value of pods that can serve them, but get no slots. 0: no
    future orders are considered."""
    scenarios: Count = 4
    """With `expected_s`, number of draws of future orders for each plan. The value of each future
    order is divided by this number."""
    expected_worth: Annotated[float, pydantic.Field(gt=0, le=1)] = 1.0
    """With `expected_s`, value of a future order as a share of the value that it would have if it
    were already waiting, before the division by `scenarios`."""
    stock_floor: Annotated[float, pydantic.Field(ge=0, le=1)] = 0.6
    """While less than this share of the space on pods is used, some robots (`bundle_share`) always
    bring pods to replenishment stations; otherwise, only robots that no pick station needs do
    so."""
    stock_ceiling: Annotated[float, pydantic.Field(ge=0, le=1)] = 1.0
    """While at least this share of the space on pods is used, no robot sets out for a replenishment
    station, so that robots are available when a pick station needs them."""
    bundle_share: Annotated[float, pydantic.Field(ge=0, le=1)] = 0.15
    """Share of all robots (at least one robot) that bring pods to replenishment stations while the
    stock is below `stock_floor`."""
    robots_per_station: Count = 9
    """Maximum number of robots at one pick station or on their way there."""
    rest: RestRule = "nearest"
    """Storage location where an idle robot waits: the one nearest to the middle of its tier
    (`middle`), the one nearest to the robot (`nearest`), or one drawn at random (`random`); if
    possible, beneath a stored pod."""
    bound_steps: Annotated[int, pydantic.Field(ge=0)] = 0
    """Number of steps in which a bound on the value of each plan is computed. The bound is only
    recorded. With the pacing `work`, these steps take no simulated time."""
    work_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 1.0
    """Limit of the search by `cp_sat` in deterministic seconds, which are close to wall time."""
