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
    or `greedy`, the start rule of both."""
    split: bool = False
    """Whether lines of an order may be served at different stations, or at different times."""
    split_orders: Annotated[int, pydantic.Field(ge=0)] | None = None
    """With `split`, maximum number of orders that may be split at a time, regardless of the put
    wall; default: as many as the wall holds, or any number without a wall."""
    visits: Annotated[int, pydantic.Field(ge=1, le=32)] = 6
    """Number of visits planned ahead per station, besides those of pods under way."""
    stations: Count = 64
    """Maximum number of pick stations planned at a time, those with the least work under way; the
    plans of the others are kept."""
    steps: Annotated[int, pydantic.Field(ge=0)] | None = None
    """Steps of the search per plan, for each station that is planned; default: 75 times the number
    of pick stations of the site, as plans of many stations take longer to improve."""
    buffer_s: NotNegative = 1.0
    """Minimum seconds between two questions, so that one question covers several decisions."""
    horizon_s: NotNegative = 60.0
    """Seconds of work on pods under way below which a station is sent another pod."""
    unit_s: NotNegative = 10.0
    """Value of a unit served, in seconds of a robot."""
    order_s: NotNegative = 5.0
    """Value of completing an order, in seconds of a robot."""
    age_reward: NotNegative = 0.002
    """Additional value of completing an order without a slot, in seconds of a robot, per second
    that the order has waited."""
    late_s: NotNegative = 0.0
    """Additional value of completing an order that is due, in seconds of a robot, times the weight
    of its class. Before the due time, the value is smaller: by the factor e for every
    `late_within_s` that is left. As later visits count less (`decay`), serving the order later
    costs part of this value (apparent tardiness cost, Vepsalainen and Morton 1987). 0: due times do
    not count."""
    late_within_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 300.0
    """Seconds before the due time at which the value `late_s` is smaller by the factor e. It should
    be about as long as the time from a plan to its last visit."""
    open_s: NotNegative = 60.0
    """Additional value of serving a line whose order already has a slot, in seconds of a robot.
    This keeps plans stable and frees slots."""
    visit_s: NotNegative = 100.0
    """Value of a visit, whatever it serves, in seconds of a robot: it keeps the station busy."""
    balance: NotNegative = 0.0
    """Additional cost of a visit, in seconds of a robot, for each second by which the work of its
    station exceeds that of the station with least work. This spreads work over stations and their
    pickers."""
    decay: Annotated[float, pydantic.Field(gt=0, le=1)] = 0.9
    """Weight of each visit of a station relative to the visit before."""
    expected_s: NotNegative = 0.0
    """Horizon in seconds of future orders considered in a plan, drawn from past orders. They raise
    the value of pods and get no slots. 0: none."""
    scenarios: Count = 4
    """With `expected_s`, number of draws of future orders for each plan; the value of a future
    order is divided by this number."""
    expected_worth: Annotated[float, pydantic.Field(gt=0, le=1)] = 1.0
    """With `expected_s`, value of serving all orders of a draw, as a share of their value if they
    were waiting."""
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
    """Maximum number of robots at, or on their way to, one pick station."""
    rest: RestRule = "nearest"
    """Where idle robots wait: near the `middle` of their tier, at the `nearest` place, or at
    `random`."""
    bound_steps: Annotated[int, pydantic.Field(ge=0)] = 0
    """Steps of the search for a bound on the value of each plan. The bound is only recorded. If the
    run is paced by work, these steps take no simulated time."""
    work_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 1.0
    """Limit of `cp_sat` in deterministic seconds of CP-SAT."""
