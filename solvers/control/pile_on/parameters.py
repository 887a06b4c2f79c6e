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


class JointParameters(SearchParameters):
    """Parameters shared by POA pile-on and TA pile-on, which use the same joint model."""

    method: Method = "joint"
    """Solution method: `greedy` (repeatedly calls the pod with the greatest gain); `joint` (the
    solution of `greedy`, improved by CP-SAT); `cp_sat` (proven optimality, for small sites);
    `hadgs` (the heuristic HADGS of Jiao et al. 2025)."""
    split: bool = False
    """Whether the lines of an order may go to different stations at different times."""
    split_orders: Annotated[int, pydantic.Field(ge=0)] | None = None
    """With `split`, maximum number of orders that may be split at a time, regardless of the put
    wall; default: as many as the wall holds, or any number without a wall."""
    part_s: NotNegative = 0.0
    """With `split`, cost of an additional tote of an order, in seconds of a robot: an order is
    split only if it would cost more to call pods that can serve it whole now."""
    later: bool = False
    """Whether an order may take a slot before pods are called for all of its lines; not possible
    with `split`."""
    open_line_s: NotNegative = 100.0
    """With `later`, cost of each line for which no pod is called yet, in seconds of a robot."""
    when_needed: bool = True
    """Whether pods are called only for stations that run out of work within the horizon; otherwise
    whenever a slot can be filled, as in the model M1G and the heuristic HADGS of Jiao et al."""
    horizon_s: NotNegative = 90.0
    """Seconds of work below which a station needs another pod."""
    by_work: bool = False
    """Whether pods are called only for stations with less work under way than the horizon, even if
    orders at other stations still lack pods. This prevents queues at one station while another runs
    out of work."""
    buffer_s: NotNegative = 3.0
    """Minimum seconds between two questions, so that one question covers several decisions."""
    work_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 0.02
    """Limit of the search in deterministic seconds of CP-SAT, which are close to wall time."""
    reward_s: NotNegative = 15.0
    """Value of each order (if orders are split: of each line) that the pods of one station
    (present, under way or called) can serve completely, in seconds of a robot."""
    unit_s: NotNegative = 0.0
    """Additional value of each unit of an order rewarded by `reward_s`, in seconds of a robot."""
    visit_s: NotNegative = 60.0
    """Cost of a visit in addition to the trip to the station, in seconds of a robot."""
    balance: NotNegative = 0.0
    """Additional cost of a visit, in seconds of a robot, for each second by which the work of its
    station exceeds that of the station with least work. This spreads work over stations and their
    pickers."""
    age_reward: NotNegative = 0.005
    """Additional value of assigning an order, in seconds of a robot, per second that the order has
    waited, times the weight of its class."""
    kept_slots: Annotated[int, pydantic.Field(ge=0)] = 1
    """Number of slots per station that are reserved for orders that the pod at the head of the
    station's queue can serve."""
    bound_steps: Annotated[int, pydantic.Field(ge=0)] = 20
    """Steps of the search for a bound on the value of each decision; more steps improve it. The
    bound is only recorded. If the run is paced by work, these steps take no simulated time."""
    pods_per_sku: Count = 4
    """Number of candidate pods per needed SKU and station passed to CP-SAT."""
    orders_per_slot: Count = 64
    """Number of candidate orders per free slot passed to CP-SAT."""

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


class PileOnParameters(JointParameters):
    """Parameters of POA pile-on."""

    triggers: tuple[AsksPileOn, ...] = ("pod-at-station", "free-slot", "short-of-work")
    """Events after which the optimiser is asked: a pod has reached a station, a slot is free for
    which nothing is planned, or a station runs out of work within the horizon (if
    `when_needed`)."""
