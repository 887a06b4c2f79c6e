"""The decision problems of an RMFS, and the events that may call for a decision."""

from __future__ import annotations

from enum import IntEnum, StrEnum
from typing import NamedTuple


class Problem(StrEnum):
    """Decision problems, mostly those of Merschformann, Xie and Li (2018, section 2.1).

    The value of a problem is its key in a controllers file.
    """

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
    CA = "ca"

    @property
    def meaning(self) -> str:
        """What the abbreviation of the problem stands for, and what is decided."""
        return _DECLARED[self].meaning

    @property
    def protocol(self) -> str:
        """The base class of all controllers of the problem, as `module:Class`.

        It defines the triggers, and the methods by which a controller is asked for decisions.
        """
        return _DECLARED[self].protocol

    @property
    def default(self) -> str:
        """Name of the rule used if a controllers file does not mention the problem."""
        return _DECLARED[self].default

    @property
    def decisions(self) -> tuple[str, ...]:
        """Names of the classes in `rmfs.control.decisions` that represent decisions of the problem.

        The tuple is empty for PP, and for PPS, PSA and repositioning, which answer questions of TA.
        """
        return _DECLARED[self].decisions


class _Declared(NamedTuple):
    meaning: str
    protocol: str
    default: str
    decisions: tuple[str, ...] = ()


_DECLARED = {
    Problem.POA: _Declared(
        "pick order assignment: order -> pick station",
        "rmfs.control.poa:PickOrderAssignment",
        "pod-match",
        ("AssignOrder", "AssignLines", "QueueOrder"),
    ),
    Problem.ROA: _Declared(
        "replenishment order assignment: bundle -> replenishment station",
        "rmfs.control.roa:ReplenishmentOrderAssignment",
        "same-pod",
        ("SendBundle",),
    ),
    Problem.RPS: _Declared(
        "replenishment pod selection: bundle -> pod",
        "rmfs.control.rps:ReplenishmentPodSelection",
        "emptiest",
        ("PromiseBundle", "ReleasePod"),
    ),
    Problem.PPS: _Declared(
        "pick pod selection: pod -> task at a station",
        "rmfs.control.pps:PodSelection",
        "lexicographic",
    ),
    Problem.PSA: _Declared(
        "pod storage assignment: pod -> storage location",
        "rmfs.control.psa:PodStorageAssignment",
        "nearest",
    ),
    Problem.TA: _Declared(
        "task allocation: task -> robot",
        "rmfs.control.ta:TaskAllocation",
        "balanced",
        (
            *("BringForPicks", "BringForBundles", "Visit", "Park", "Reposition", "Rest"),
            *("Prepare", "WorkFor", "Store", "MovePod"),
        ),
    ),
    Problem.SA: _Declared(
        "station activation: which stations take new work",
        "rmfs.control.sa:StationActivation",
        "all",
        ("SwitchStation",),
    ),
    Problem.MM: _Declared(
        "method management: exchange of controllers in a running system",
        "rmfs.control.mm:MethodManagement",
        "none",
        ("Exchange",),
    ),
    Problem.PP: _Declared("path planning", "rmfs.control.pp:PathPlanning", "time-windows"),
    Problem.REPOSITIONING: _Declared(
        "repositioning: idle pod -> another storage location",
        "rmfs.control.repositioning:Repositioning",
        "none",
    ),
    Problem.CA: _Declared(
        "charge assignment: robot -> where, from when and up to which level it is charged",
        "rmfs.control.ca:ChargeAssignment",
        "threshold",
        ("Charge", "Unplug"),
    ),
}
"""Declaration of every problem; all else about a problem is in its package of `rmfs.control`."""


class Trigger(IntEnum):
    """Events that may call for a decision, each with its subject (if any) in brackets."""

    START = 0
    """The run begins [no subject]."""
    NEW_ORDER = 1
    """An order joined the backlog [Order]."""
    ORDER_ASSIGNED = 2
    """An order was assigned to a pick station [Order]."""
    UNIT_PICKED = 3
    """The pick of a unit begins; the unit no longer counts as on its pod [pod, SKU]."""
    ORDER_COMPLETED = 4
    """A pick station has passed on an order, or a part of a split order; its slot is free
    [Order]."""
    NEW_BUNDLE = 5
    """A bundle joined the backlog [Bundle]."""
    BUNDLE_PROMISED = 6
    """RPS chose a pod for a bundle [Bundle]."""
    BUNDLE_RELEASED = 7
    """RPS released the bundles promised to a pod [pod]."""
    BUNDLE_SENT = 8
    """ROA chose a station for a bundle [Bundle]."""
    BUNDLE_ASSIGNED = 9
    """Both the pod and the station of a bundle have been chosen [Bundle]."""
    BUNDLE_STORED = 10
    """The transfer of a bundle begins; from now on its units count as stock [Bundle]."""
    STATION_SWITCHED = 11
    """A station was switched on or off [station]."""
    ROBOT_FREE = 12
    """A robot needs a task [robot]."""
    POD_AT_HAND = 13
    """A pod has become available [no subject]."""
    POD_LIFTED = 14
    """A robot starts to lift a pod [pod]."""
    POD_AT_STATION = 15
    """A robot, with or without a pod, reached the head of a station's queue [station]."""
    ORDER_QUEUED = 16
    """An order of the backlog joined the pool of a pick station [Order]."""
    ORDER_CUT = 17
    """Units that are not in stock were cut from an order of the backlog, which stock can now serve
    [Order]."""
    POOL_CHANGED = 18
    """Other pods than before may be useful for the pool of a pick station: the station has a free
    slot again, or only some of the open units of an order in the pool were bound to a pod
    [station]."""
