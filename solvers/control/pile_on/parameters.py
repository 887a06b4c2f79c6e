"""What can be set of the joint control of orders and pods."""

from __future__ import annotations

from typing import Annotated, Literal, Self

import pydantic

from rmfs.solvers.control.parameters import SearchParameters
from rmfs.solvers.models.pile_on import Pruning, Variant, Weights

NotNegative = Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)]
Count = Annotated[int, pydantic.Field(ge=1)]
Method = Literal["joint", "cp_sat", "greedy", "hadgs"]
AsksPileOn = Literal["pod-at-station", "free-slot", "short-of-work"]


class JointParameters(SearchParameters):
    """What both controllers that ask the joint model have in common."""

    method: Method = "joint"
    """Who decides: `joint` (pod match, improved by CP-SAT); `greedy`, pod match alone; `cp_sat`,
    every question to proven optimality over all pairs, for small sites; `hadgs` (Jiao et al.)."""
    split: bool = False
    """Whether the lines of an order may go to different stations at different times."""
    split_orders: Annotated[int, pydantic.Field(ge=0)] | None = None
    """With `split`, orders that may be split at a time, whatever the put wall holds; default: as
    many as it holds, and any number where there is none."""
    part_s: NotNegative = 0.0
    """With `split`, seconds of a robot that another tote of an order costs: an order is split only
    if the pods that would serve it whole now cost more."""
    later: bool = False
    """Whether a whole order may take a slot while some of its lines wait for pods to come."""
    open_line_s: NotNegative = 100.0
    """Seconds of a robot that each such line costs."""
    when_needed: bool = True
    """Whether pods are called only for stations that run out of work within the horizon; otherwise
    whenever a slot can be filled, as in M1G and HADGS."""
    horizon_s: NotNegative = 90.0
    """Seconds of work below which a station needs another pod."""
    by_work: bool = False
    """Whether pods are called only for stations with less work on its way than the horizon,
    whatever their orders lack: no station is sent a queue of pods while another runs dry."""
    buffer_s: NotNegative = 3.0
    """Seconds for which decisions are collected before the optimiser is asked again."""
    work_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 0.02
    """Limit of the search in deterministic seconds of CP-SAT: about the same in wall time."""
    reward_s: NotNegative = 15.0
    """Seconds of a robot that one more order (if orders are split: line) of a visit is worth."""
    unit_s: NotNegative = 0.0
    """What each unit of such an order is worth besides."""
    visit_s: NotNegative = 60.0
    """Seconds that a visit costs a robot besides the way to the station."""
    balance: NotNegative = 0.0
    """Seconds of a robot that a visit costs more for each second of work that its station has more
    than the one with least: work is spread over stations and their pickers."""
    age_reward: NotNegative = 0.005
    """What a second of waiting adds to the worth of an order that gets a slot, times the weight of
    its class."""
    kept_slots: Annotated[int, pydantic.Field(ge=0)] = 1
    """Slots of each station kept for what the pod at its head can serve."""
    bound_steps: Annotated[int, pydantic.Field(ge=0)] = 20
    """Steps of the search for a bound of each decision, for the record; more make it better. They
    are not counted as work."""
    pods_per_sku: Count = 4
    """Candidate pods per wanted SKU and station that CP-SAT is given."""
    orders_per_slot: Count = 64
    """Candidate orders per free slot that CP-SAT is given."""

    @property
    def pruning(self) -> Pruning:
        """How many candidates are kept."""
        return Pruning(pods_per_sku=self.pods_per_sku, orders_per_slot=self.orders_per_slot)

    @property
    def weights(self) -> Weights:
        """The objective, in seconds of a robot."""
        return Weights(
            visit=self.visit_s,
            complete=self.reward_s,
            unit=self.unit_s,
            open_line=self.open_line_s,
        )

    @property
    def variant(self) -> Variant:
        """How orders, or lines that are orders of their own, may be covered."""
        return Variant.LATER if self.later else Variant.WHOLE

    @pydantic.model_validator(mode="after")
    def _whole_if_later(self) -> Self:
        if self.later and self.split:
            raise ValueError("later: not with split, where every line takes a slot by itself")
        return self


class PileOnParameters(JointParameters):
    """Parameters of POA pile-on."""

    triggers: tuple[AsksPileOn, ...] = ("pod-at-station", "free-slot", "short-of-work")
    """After what the optimiser is asked: a pod has reached a station, a slot is free for which
    nothing is planned, a station runs out of work within the horizon (if `when_needed`)."""
