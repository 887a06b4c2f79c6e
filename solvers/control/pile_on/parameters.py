"""Parameters of the joint control of orders and pods."""

from __future__ import annotations

from typing import Annotated, Literal, Self

import pydantic

from rmfs.solvers.control.parameters import SearchParameters
from rmfs.solvers.models.pile_on import Pruning, Variant, Weights

NotNegative = Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)]
Count = Annotated[int, pydantic.Field(ge=1)]
Method = Literal["joint", "cp_sat", "greedy", "hadgs"]
AsksPileOn = Literal["pod-at-station", "free-slot", "short-of-work"]

_ONLY_JOINT = ("work_s", "pods_per_sku", "orders_per_slot")
"""Parameters that limit the search of the method `joint`, but not that of `cp_sat`."""


class JointParameters(SearchParameters):
    """Parameters shared by POA pile-on and TA pile-on, which use the same joint model."""

    method: Method = "joint"
    """Solution method: `greedy` (repeatedly calls the pod with the greatest gain); `joint` (the
    solution of `greedy`, improved by CP-SAT); `cp_sat` (CP-SAT until `gap` is reached, for small
    sites); `hadgs` (the heuristic HADGS of Jiao et al. 2025)."""
    split: bool = False
    """Whether the lines of an order may be assigned separately, to different stations or at
    different times."""
    split_orders: Annotated[int, pydantic.Field(ge=0)] | None = None
    """With `split`, maximum number of orders that are split at the same time. By default, as many
    as the put wall holds, or any number without a put wall. If a number is given, it applies
    instead of the space on the put wall."""
    part_s: NotNegative = 0.0
    """With `split`, cost of an additional tote of an order, in seconds of robot time. An order is
    split only if that costs less than calling the pods that would serve it whole at one station
    now."""
    later: bool = False
    """Whether an order may get a slot before pods are called for all of its lines; not possible
    with `split`."""
    open_line_s: NotNegative = 100.0
    """With `later`, cost, in seconds of robot time, of each line of an order that gets a slot
    before a pod is called for the line."""
    when_needed: bool = True
    """Whether pods are called only for stations that run out of work within `horizon_s` or need
    units that no pod brings. If false, pods are called whenever a slot can be filled, as in the
    model M1G and the heuristic HADGS of Jiao et al. (2025)."""
    horizon_s: NotNegative = 90.0
    """With `when_needed` or `by_work`, seconds of work below which a station needs another pod."""
    by_work: bool = False
    """Whether pods are called only for stations that have less than `horizon_s` of work left. Work
    on pods that are present, under way or called counts. Other stations get no pods, even if some
    of their orders still lack one. This prevents queues at one station while another runs out of
    work."""
    buffer_s: NotNegative = 3.0
    """Minimum time, in seconds, between two questions to the optimiser, so that one question covers
    several decisions."""
    work_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 0.02
    """With the method `joint`, limit of the search by CP-SAT in deterministic seconds, which are
    close to wall time. The method `cp_sat` has no such limit, and refuses another value."""
    reward_s: NotNegative = 15.0
    """Value, in seconds of robot time, of each order (with `split`, of each line) that the pods of
    one station (present, under way or called) can serve completely."""
    unit_s: NotNegative = 0.0
    """Additional value, in seconds of robot time, of each unit of an order rewarded by
    `reward_s`."""
    visit_s: NotNegative = 60.0
    """Cost of a visit, in seconds of robot time, in addition to the trip to the station."""
    balance: NotNegative = 0.0
    """Additional cost of a visit, in seconds of robot time, for each second by which the work of
    the visited station exceeds that of the station with the least work. This spreads work over
    stations and their pickers."""
    age_reward: NotNegative = 0.005
    """Additional value of assigning an order, in seconds of robot time, per second that the order
    has waited, times the weight of the order's class."""
    kept_slots: Annotated[int, pydantic.Field(ge=0)] = 1
    """Number of slots of each station that are reserved for orders that the pod at the head of the
    station's queue can serve."""
    bound_steps: Annotated[int, pydantic.Field(ge=0)] = 20
    """Number of steps in which a bound on the value of each decision is computed; more steps
    improve the bound. The bound is only recorded. With the pacing `work`, these steps take no
    simulated time."""
    pods_per_sku: Count = 4
    """With the method `joint`, number of pods that CP-SAT considers for each needed SKU at each
    station. The method `cp_sat` considers all, and refuses another value."""
    orders_per_slot: Count = 64
    """With the method `joint`, number of orders that CP-SAT considers for each free slot. The
    method `cp_sat` considers all, and refuses another value."""

    @property
    def pruning(self) -> Pruning:
        """Return the limits on the candidate pods and orders passed to CP-SAT."""
        return Pruning(pods_per_sku=self.pods_per_sku, orders_per_slot=self.orders_per_slot)

    @property
    def weights(self) -> Weights:
        """Return the weights of the objective, in seconds of robot time."""
        return Weights(
            visit=self.visit_s,
            complete=self.reward_s,
            unit=self.unit_s,
            open_line=self.open_line_s,
        )

    @property
    def variant(self) -> Variant:
        """Return the variant of the model: `LATER` if `later` is true, otherwise `WHOLE`."""
        return Variant.LATER if self.later else Variant.WHOLE

    @pydantic.model_validator(mode="after")
    def _whole_if_later(self) -> Self:
        if self.later and self.split:
            raise ValueError(
                "later: cannot be combined with split, in which every line takes its own slot"
            )
        return self

    @pydantic.model_validator(mode="after")
    def _exact_without_limits(self) -> Self:
        if self.method == "cp_sat":
            for name in _ONLY_JOINT:
                if getattr(self, name) != type(self).model_fields[name].default:
                    raise ValueError(
                        f"{name}: has no effect with method cp_sat, which considers everything and "
                        "searches until gap is reached; leave it out, or choose method joint"
                    )
        return self


class PileOnParameters(JointParameters):
    """Parameters of POA pile-on."""

    triggers: tuple[AsksPileOn, ...] = ("pod-at-station", "free-slot", "short-of-work")
    """Events after which the optimiser is asked: `pod-at-station` (a pod has reached a station),
    `free-slot` (a station with a free slot has no planned orders) and `short-of-work` (with
    `when_needed`, a station has less than `horizon_s` seconds of work)."""
