"""The value of perfect foresight: storage locations and robots of a run, chosen in retrospect.

The visits of pods to stations, and the times at which pods are lifted and set down, are kept as in
the run. With these visits and times known in advance, PSA could have chosen other storage locations
to reduce loaded driving, and TA could have chosen other robots to reduce empty driving. For each of
these two problems, a lower bound on the driving time is proven. With everything else unchanged, a
better PSA or TA could have saved at most the driving time of the run minus this bound.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import linear_sum_assignment

from rmfs.measure.base import Measure
from rmfs.measure.columns import INTEGER, REAL, Column
from rmfs.solvers.models.storage.stays import Stays
from rmfs.solvers.models.storage.stays import solve as solve_stays

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.control.travel import TravelTimes
    from rmfs.measure.ended import EndedRun

    Floats = NDArray[np.float64]

TOLERANCE_S = 0.001
"""Tolerance in s, as travel times are rounded to microseconds."""


class Foresight(Measure):
    """Driving time that better storage locations or a better choice of robots could save in a run.

    The measure is valid only for runs on one tier without repositioning. Savings are given in s and
    as shares of the total time of all robots (duration times number of robots). Each saving is an
    upper bound on what other decisions of PSA, or of TA, could have saved if nothing else had
    changed.
    """

    columns = (
        Column("stays", INTEGER, "stays", "Stays whose storage locations were optimised"),
        Column(
            "foresight_storage_s",
            REAL,
            "s",
            "Upper bound on the unhindered loaded driving that perfect foresight of the next "
            "visits could have saved by other storage locations (PSA)",
        ),
        Column(
            "foresight_storage_share",
            REAL,
            "share",
            "foresight_storage_s / (robots x duration)",
        ),
        Column("lifts", INTEGER, "lifts", "Trips to pods whose robots were optimised"),
        Column(
            "foresight_tasks_s",
            REAL,
            "s",
            "Upper bound on the unhindered empty driving that perfect foresight of the next "
            "lifts could have saved by other robots (TA)",
        ),
        Column(
            "foresight_tasks_share",
            REAL,
            "share",
            "foresight_tasks_s / (robots x duration)",
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Solve both problems; return the run's driving times minus proven lower bounds."""
        trips, times = run.tables["trips"], run.recorder.traffic
        data, stored_s = stays_of(run, trips, times)
        saved_s = max(stored_s - solve_stays(data, "highs").bound, 0.0)
        empty_s, least_s, lifts = lifts_of(trips, times)
        robot_s = run.layout.robots * run.duration_s
        return {
            "stays": len(data.begin_s),
            "foresight_storage_s": saved_s,
            "foresight_storage_share": saved_s / robot_s,
            "lifts": lifts,
            "foresight_tasks_s": empty_s - least_s,
            "foresight_tasks_share": (empty_s - least_s) / robot_s,
        }


def stays_of(run: EndedRun, trips: pd.DataFrame, times: TravelTimes) -> tuple[Stays, float]:
    """Return the stays of pods at storage locations in a run, and their total cost, in s.

    A stay begins when a robot starts to carry a pod to a storage location, and ends when a robot
    begins to lift the pod again; for this time, the location is reserved for the pod. The cost
    of a stay is the unhindered time of the drive from the previous station to the location and of
    the drive from there to the next station, if any. A pod that stands at a storage location at the
    beginning stays there, at no cost, until it is first lifted; the storage locations of pods that
    never move are left out.

    Parameters
    ----------
    run
        The run; its layout, its end and the final positions of pods are used.
    trips
        Table of trips of the run.
    times
        Unhindered travel times on the layout.

    Returns
    -------
    The stays, as data of the model `stays`, with each storage location as a zone of its own; and
    their total cost in the run, in s.
    """
    loaded = trips[trips["loaded"]]
    lifts = {
        place: loaded[loaded["from_waypoint"] == place]
        for place in loaded["from_waypoint"].unique().tolist()
    }
    stored = loaded[loaded["kind"] == "to_storage"].sort_values("start_s")
    filled = stored.groupby("to_waypoint")["start_s"].min().to_dict()
    at_end = run.world.storage.pod_at
    lift_s = max(kind.pod_transfer_s for kind in run.layout.robot_kinds)
    moved = [
        place
        for place in np.flatnonzero(run.layout.is_storage).tolist()
        if place in filled or place in lifts or at_end[place] < 0
    ]
    column = {place: number for number, place in enumerate(moved)}
    begin_s, end_s, cost_s = [], [], []
    for place in moved:
        left_s = lifts[place]["start_s"].min() if place in lifts else np.inf
        if left_s < filled.get(place, np.inf):  # its pod was there from the start
            begin_s.append(0.0)
            end_s.append(max(float(left_s) - lift_s, TOLERANCE_S))
            cost_s.append(_only(column[place], len(moved)))
    spent_s = 0.0
    for start_s, arrival_s, station, place in stored[
        ["start_s", "end_s", "from_waypoint", "to_waypoint"]
    ].itertuples(index=False):
        ways_s = np.array(times.travel_times_from(int(station), loaded=True))
        following = lifts.get(int(place))
        if following is not None:
            following = following[following["start_s"] >= arrival_s].nsmallest(1, "start_s")
        if following is not None and len(following):
            left_s = float(following["start_s"].iloc[0]) - lift_s
            ways_s += times.travel_times_to(int(following["to_waypoint"].iloc[0]), loaded=True)
        else:  # lifted for a trip that had not ended, at a moment nobody knows: as early as can be
            left_s = run.end_s if at_end[int(place)] >= 0 else arrival_s
        begin_s.append(float(start_s))
        end_s.append(float(left_s))
        spent_s += float(ways_s[int(place)])
        cost_s.append(ways_s[moved])
    places = np.ones(len(moved), np.int64)
    return Stays(np.array(begin_s), np.array(end_s), np.array(cost_s), places), spent_s


def lifts_of(trips: pd.DataFrame, times: TravelTimes) -> tuple[float, float, int]:
    """Return the total time of empty trips to pods, and its minimum over all choices of robots.

    Each trip to a pod in the run provides a free robot, at the time and place at which the trip
    began, and a pod to be lifted, at the place at which the trip ended. A choice assigns one of the
    free robots to each pod, such that every pod is reached no later than in the run.

    Parameters
    ----------
    trips
        Table of trips of a run.
    times
        Unhindered travel times on the layout.

    Returns
    -------
    Unhindered time of the trips to pods in the run, and its minimum over all choices of robots, in
    s; and the number of these trips.
    """
    to_pod = trips[trips["kind"] == "to_pod"].sort_values("start_s")
    arrival_s = to_pod["end_s"].to_numpy()
    free_s, free_at = to_pod["start_s"].to_numpy(), to_pod["from_waypoint"].to_numpy()
    pods_at = to_pod["to_waypoint"].to_numpy()
    ways_s = {
        int(place): np.asarray(times.travel_times_to(int(place), loaded=False))[free_at]
        for place in np.unique(pods_at)
    }
    cost_s = np.array([ways_s[int(place)] for place in pods_at])
    own_s = float(np.trace(cost_s))
    late = free_s[np.newaxis, :] + cost_s > arrival_s[:, np.newaxis] + TOLERANCE_S
    np.fill_diagonal(late, val=False)
    # a matching that is late anywhere costs more than all of the run's
    row, col = linear_sum_assignment(np.where(late, own_s + 1.0, cost_s))
    return own_s, float(cost_s[row, col].sum()), len(to_pod)


def _only(column: int, columns: int) -> Floats:
    """Return the costs of places: 0 for one of them, infinite for all others."""
    cost = np.full(columns, np.inf)
    cost[column] = 0.0
    return cost
