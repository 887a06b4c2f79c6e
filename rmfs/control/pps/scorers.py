"""Scorers of pods: the higher, the better. Each is a model, so a file can choose and set it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

import pydantic

from rmfs.control.base import Parameters

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from rmfs.control.pps.candidates import Candidates, PickCandidates

    Scores = NDArray[np.float64] | NDArray[np.int64]

_OTHER_TIER = 1000.0
"""Units that a pod on another tier is worth less: more than any pod can serve."""


class RandomScorer(Parameters):
    """Any pod; those on the tiers of robot and station first if so wished."""

    scorer: Literal["random"] = "random"
    prefer_same_tier: bool = True

    def score(self, candidates: Candidates, rng: np.random.Generator) -> Scores:
        """Uniform in [0, 1), less one for robot and for station on another tier."""
        scores: Scores = rng.random(len(candidates))
        return scores - candidates.other_tiers() if self.prefer_same_tier else scores


class Nearest(Parameters):
    """Shortest way from the robot to the pod and on to the station."""

    scorer: Literal["nearest"] = "nearest"
    metric: Literal["time", "distance"] = "time"
    """`time`: estimated time from robot to pod plus exact time from pod to station; `distance`:
    Euclidean distances."""

    def score(self, candidates: Candidates, rng: np.random.Generator) -> Scores:
        """Minus seconds, or minus metres."""
        if self.metric == "time":
            return -_seconds(candidates)
        travel = candidates.view.travel
        pods = candidates.waypoints()
        from_robot = travel.metres(travel.robot_waypoint(candidates.robot.index), pods)
        return -(from_robot + travel.metres(candidates.station.waypoint, pods))


class Completeable(Parameters):
    """Most orders of the station completed."""

    scorer: Literal["completeable"] = "completeable"

    def score(self, candidates: PickCandidates, rng: np.random.Generator) -> Scores:
        """Orders of the station of which the pod covers all open requests."""
        return candidates.completed()[0]


class PickWorkAmount(Parameters):
    """Most picks, with a price for the way ("pile-on" in later literature)."""

    scorer: Literal["work-amount"] = "work-amount"
    time_cost: Annotated[float, pydantic.Field(ge=0)] = 1 / 3
    """Picks that one second of travel is worth."""
    completable_boost: Annotated[float, pydantic.Field(ge=0)] = 1.0
    """Units of orders that the pod can complete count so much more: 1 for twice."""
    prefer_same_tier: bool = True
    """Whether pods on the tiers of robot and station come first."""

    def score(self, candidates: PickCandidates, rng: np.random.Generator) -> Scores:
        """Servable requests plus boost, less travel time times its cost."""
        scores: Scores = candidates.servable_units() + (
            self.completable_boost * candidates.completed()[1]
        )
        if self.time_cost:
            scores = scores - self.time_cost * _seconds(candidates)
        if self.prefer_same_tier:
            scores = scores - _OTHER_TIER * candidates.other_tiers()
        return scores


class BundleWorkAmount(Parameters):
    """Most bundles."""

    scorer: Literal["work-amount"] = "work-amount"
    prefer_same_tier: bool = True
    """Whether pods on the tiers of robot and station come first."""

    def score(self, candidates: Candidates, rng: np.random.Generator) -> Scores:
        """Bundles that wait at the station for the pod."""
        view = candidates.view
        row = view.bundles_waiting[candidates.station.index - len(view.pick_stations)]
        scores: Scores = row[candidates.pods].astype(float)
        if self.prefer_same_tier:
            scores = scores - _OTHER_TIER * candidates.other_tiers()
        return scores


def _seconds(candidates: Candidates) -> NDArray[np.float64]:
    """Estimated time to reach each pod, and exact time from there to the station, (C,)."""
    travel = candidates.view.travel
    pods = candidates.waypoints()
    to_pod = travel.estimate_s(travel.robot_waypoint(candidates.robot.index), pods)
    seconds: NDArray[np.float64] = (
        to_pod + travel.to(candidates.station.waypoint, loaded=True)[pods]
    )
    return seconds


def _by_name(value: Any) -> Any:
    """Let a plain name stand for a scorer with its defaults."""
    return {"scorer": value} if isinstance(value, str) else value


PickScorer = Annotated[
    RandomScorer | Nearest | Completeable | PickWorkAmount,
    pydantic.Field(discriminator="scorer"),
    pydantic.BeforeValidator(_by_name),
]
BundleScorer = Annotated[
    RandomScorer | Nearest | BundleWorkAmount,
    pydantic.Field(discriminator="scorer"),
    pydantic.BeforeValidator(_by_name),
]
