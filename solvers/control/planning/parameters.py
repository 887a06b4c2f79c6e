"""What can be set of the planning controller."""

from __future__ import annotations

from typing import Annotated, Literal

import pydantic

from rmfs.control.ta.rest import RestRule
from rmfs.solvers.control.parameters import SearchParameters

NotNegative = Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)]
Count = Annotated[int, pydantic.Field(ge=1)]


class PlanningParameters(SearchParameters):
    """Parameters of TA planning."""

    method: Literal["lns", "greedy", "cp_sat"] = "lns"
    """Who plans: `lns` (large neighbourhood search), `cp_sat` (exact, for very small sites), or the
    start rule of both, `greedy`."""
    split: bool = False
    """Whether lines of an order may go to different stations, or to one at different times."""
    split_orders: Annotated[int, pydantic.Field(ge=0)] | None = None
    """With `split`, orders that may be split at a time, whatever the put wall holds; default: as
    many as it holds, and any number where there is none."""
    visits: Annotated[int, pydantic.Field(ge=1, le=32)] = 6
    """Visits per station that are planned ahead, besides those of pods under way."""
    stations: Count = 64
    """Pick stations planned for at a time, those with the least work on its way; what is planned
    for the others stays."""
    steps: Annotated[int, pydantic.Field(ge=0)] = 150
    """Steps of the search for each plan and station that is planned for."""
    buffer_s: NotNegative = 1.0
    """Seconds for which decisions are collected before the optimiser is asked again."""
    horizon_s: NotNegative = 60.0
    """Seconds of work, on pods under way, below which a station is sent another pod."""
    unit_s: NotNegative = 10.0
    """Seconds of a robot that a unit served is worth."""
    order_s: NotNegative = 5.0
    """Seconds of a robot that an order closed is worth."""
    age_reward: NotNegative = 0.002
    """What a second of waiting adds to the worth of closing an order."""
    late_s: NotNegative = 0.0
    """Seconds of a robot that closing an order is worth more once it is due, times the weight of
    its class; before, this falls by the factor e for every `late_within_s` left. As later visits
    count less (`decay`), it is the price of tardiness (apparent tardiness cost, Vepsalainen and
    Morton 1987). 0: due times do not count."""
    late_within_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 300.0
    """See `late_s`; about the time from a plan to its last visit."""
    open_s: NotNegative = 60.0
    """What a line is worth more if its order has a slot already: plans are kept to, and slots get
    free."""
    visit_s: NotNegative = 100.0
    """Seconds of a robot that a visit is worth whatever it serves, as its station has work."""
    balance: NotNegative = 0.0
    """Seconds of a robot that a visit costs more for each second of work that its station has more
    than the one with least: work is spread over stations and their pickers."""
    decay: Annotated[float, pydantic.Field(gt=0, le=1)] = 0.9
    """What the next visit of a station counts, as a share of this one."""
    stock_floor: Annotated[float, pydantic.Field(ge=0, le=1)] = 0.6
    """Share of the space in use below which robots always work for bundles; above it, robots that
    no pick station needs do."""
    stock_ceiling: Annotated[float, pydantic.Field(ge=0, le=1)] = 1.0
    """Share of the space in use from which on no robot sets out for bundles: those that no pick
    station needs are at hand then when one does."""
    bundle_share: Annotated[float, pydantic.Field(ge=0, le=1)] = 0.15
    """Share of the robots, and one at least, that work for bundles below the floor."""
    robots_per_station: Count = 9
    """How many robots may be at, or on their way to, one pick station."""
    rest: RestRule = "nearest"
    """Where idle robots wait: near the `middle` of their tier, at the `nearest` place, or at
    `random`."""
    bound_steps: Annotated[int, pydantic.Field(ge=0)] = 0
    """Steps of the search for a bound of each plan, for the record. They are not counted as
    work."""
    work_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 1.0
    """Limit of `cp_sat` in deterministic seconds of CP-SAT."""
