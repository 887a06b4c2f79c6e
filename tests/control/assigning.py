"""Decisions of POA, ROA and RPS rules, applied to the world as the simulation does."""

from __future__ import annotations

from doubles import Situation, small_layout

from rmfs.control.decisions import PromiseBundle


def stocked() -> Situation:
    """Two pick stations with four slots, at x = 0 and 10; ten units of SKU k on pod k at x = k.

    Robots 0 and 1.
    """
    made = Situation(small_layout(pods=4, pick_stations=2, slots=4))
    for pod in range(4):
        made.stock(pod, **{f"s{pod}": 10})
    return made


def assign(situation: Situation, controller) -> list[tuple[int, int]]:
    """Apply the decisions of a POA rule; returns order and station of each."""
    made = []
    for order, station in controller.decide():
        situation.world.assign_order(order, station)
        made.append((order.index, station))
    return made


def promise(situation: Situation, controller) -> list[tuple]:
    """Apply the decisions of an RPS rule; returns ("promise", bundle, pod) and ("release", pod)."""
    made = []
    for decision in controller.decide():
        if isinstance(decision, PromiseBundle):
            situation.world.promise(decision.bundle, decision.pod)
            made.append(("promise", decision.bundle.index, decision.pod))
        else:
            situation.world.release_bundles(decision.pod)
            made.append(("release", decision.pod))
    return made


def send(situation: Situation, controller) -> list[tuple[int, int]]:
    """Apply the decisions of an ROA rule; returns bundle and station of each."""
    made = []
    for bundle, station in controller.decide():
        situation.world.choose_station(bundle, station)
        made.append((bundle.index, station))
    return made
