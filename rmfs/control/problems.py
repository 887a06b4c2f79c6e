"""The decision problems of an RMFS, and the events that may call for a decision."""

from __future__ import annotations

from enum import IntEnum, StrEnum


class Problem(StrEnum):
    """Decision problems (paper, section 2.1); the value is the table in a controllers file."""

    POA = "poa"
    ROA = "roa"
    RPS = "rps"
    PPS = "pps"
    PSA = "psa"
    TA = "ta"
    SA = "sa"
    MM = "mm"
    PP = "pp"
    REPOSITIONING = "repositioning"

    @property
    def meaning(self) -> str:
        """What the abbreviation stands for."""
        return _MEANINGS[self]


_MEANINGS = {
    Problem.POA: "pick order assignment: order -> pick station",
    Problem.ROA: "replenishment order assignment: bundle -> replenishment station",
    Problem.RPS: "replenishment pod selection: bundle -> pod",
    Problem.PPS: "pick pod selection: pod -> task at a station",
    Problem.PSA: "pod storage assignment: pod -> storage place",
    Problem.TA: "task allocation: task -> robot",
    Problem.SA: "station activation: which stations take new work",
    Problem.MM: "method management: exchange of controllers in a running system",
    Problem.PP: "path planning",
    Problem.REPOSITIONING: "repositioning: idle pod -> another storage place",
}


class Trigger(IntEnum):
    """Events of the simulated world; what comes with each is named in brackets."""

    START = 0
    """The run begins, or the controller has just been installed."""
    NEW_ORDER = 1
    """An order joined the backlog [Order]."""
    ORDER_ASSIGNED = 2
    """An order was put on a pick station [Order]."""
    UNIT_PICKED = 3
    """A unit left a pod [pod, SKU]."""
    ORDER_COMPLETED = 4
    """A pick station handed an order on [Order]."""
    NEW_BUNDLE = 5
    """A bundle joined the backlog [Bundle]."""
    BUNDLE_PROMISED = 6
    """RPS chose a pod for a bundle [Bundle]."""
    BUNDLE_RELEASED = 7
    """RPS released the bundles promised to a pod [pod]."""
    BUNDLE_SENT = 8
    """ROA chose a station for a bundle [Bundle]."""
    BUNDLE_ASSIGNED = 9
    """Pod and station of a bundle are both decided [Bundle]."""
    BUNDLE_STORED = 10
    """A bundle starts to go into its pod [Bundle]."""
    STATION_SWITCHED = 11
    """A station was switched on or off [station]."""
    ROBOT_FREE = 12
    """A robot needs a task [robot]."""
    POD_AT_HAND = 13
    """Some pod can be claimed that could not before [nothing]."""
    POD_LIFTED = 14
    """A robot starts to lift a pod [pod]."""
    POD_AT_STATION = 15
    """A robot with its pod reached the head of a queue [station]."""
    ORDER_QUEUED = 16
    """An order of the backlog joined the pool of a pick station [Order]."""
