"""Statistics and records of the robots' motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.traffic.trace import joined_holds

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.traffic._core import Core


class Readings:
    """Motion, energy, heat, trips, trace and counters of the robots of a layout."""

    _core: Core

    def motion(self) -> dict[str, NDArray[Any]]:
        """Return totals per robot since the last reset, up to now, each of shape (R,).

        The distances are `distance_m` and, with a pod, `loaded_distance_m`. The times `moving_s`,
        `turning_s`, `waiting_s` (standing on the way), `served_s` (standing at a station),
        `idle_s`, `transfer_s` (lifting, setting down) and `riding_s` (elevators) add up to the
        elapsed time. `queueing_s` counts from entering a queue zone to reaching the station and
        overlaps with the others; `awaiting_plan_s`, standing without the plan that the robot needs,
        is part of `waiting_s`.
        """
        return self._core.motion()

    def energy(self) -> dict[str, NDArray[Any]]:
        """Return the energy of each robot, up to now, in columns of shape (R,).

        Since the last reset: `drive_j`, `turn_j`, `lift_j`, `standby_j`, `recuperated_j`,
        `charged_j` and `charging_s`; `used_j` is the sum of `drive_j`, `turn_j`, `lift_j` and
        `standby_j` minus `recuperated_j`. Since time zero: `initial_j`, `ever_charged_j` and
        `ever_used_j`; `level_j` is the sum of `initial_j` and `ever_charged_j` minus `ever_used_j`.
        Energies are in J.

        Raises
        ------
        ValueError
            If energy is not modelled.
        """
        return self._core.energy()

    def used_j(self, robot: int) -> float:
        """Return the energy used by a robot since time zero, less recuperated energy, in J."""
        return self._core.used(robot)

    def level_j(self, robot: int) -> float:
        """Return the energy in the battery of a robot, in J."""
        return self._core.level(robot)

    def heat(self) -> dict[str, NDArray[Any]]:
        """Count visits and standing time of robots that are not idle, since the last reset.

        Per waypoint, shape (N,): `visits` and `waiting_s`, and the part of them with a pod,
        `loaded_visits` and `loaded_waiting_s`. Per pair of waypoint and purpose that occurred,
        shape (M,): `stays_waypoint`, `stays_purpose`, `stays_visits` and `stays_waiting_s`. The
        purpose is the number of the station for which a robot works, also while it fetches the pod.
        It is S, the number of stations, if the robot stores a pod or fetches one for no station,
        and S + 1 for everything else.
        """
        counted: dict[str, NDArray[Any]] = self._core.heat()
        at, waypoints = counted["stays_waypoint"], len(counted["loaded_visits"])
        visits = np.bincount(at, counted["stays_visits"], waypoints).astype(np.int64)
        waiting_s = np.bincount(at, counted["stays_waiting_s"], waypoints)
        return {"visits": visits, "waiting_s": waiting_s, **counted}

    def edges(self) -> dict[str, NDArray[Any]]:
        """Return the edges and elevator rides used since the last reset, by their end points.

        The columns are `from_wp`, `to_wp`, `passages`, and `loaded_passages` for those with a pod.
        """
        return self._core.edges()

    def trips(self) -> dict[str, NDArray[Any]]:
        """Return the trips finished since the last reset, ordered by their end.

        The columns are `robot`, `kind` (`TripKind`), `t0_us`, `t1_us` (a trip to a station ends at
        its queue zone), `from_wp`, `to_wp`, `loaded`, `distance_m`, `unhindered_s` (lower bound of
        the time from rest to rest), `energy_j` (0 if energy is not counted), `awaited_s` (time at
        its beginning in which the robot waited for its plan).
        """
        return self._core.trips()

    def trace(self) -> dict[str, NDArray[Any]]:
        """Return the recorded motion so far, in rows sorted by robot and time.

        The columns are `robot`, `t0_us`, `t1_us`, `kind` (`Piece`), `from_wp`, `to_wp`,
        `heading0_rad`, `heading1_rad`, `pod` (carried, -1 without), `top_speed_m_s`.

        Raises
        ------
        ValueError
            If the trace is not recorded.
        """
        return joined_holds(self._core.trace(0)[0])

    def trace_after(self, known: int) -> tuple[dict[str, NDArray[Any]], int]:
        """Return the part of the trace that previous calls have not returned, to follow a run.

        The motion that each robot is currently executing is included, and is returned again until
        it has ended. A row therefore replaces everything that earlier calls returned for its robot
        from `t0_us` on. If a robot stands still during several calls, it gets several consecutive
        rows, which `joined_holds` merges.

        Parameters
        ----------
        known
            The number returned by the previous call; 0 at first.

        Returns
        -------
        tuple
            The columns of `trace`, and the number to pass to the next call.

        Raises
        ------
        ValueError
            If the trace is not recorded.
        """
        return self._core.trace(known)

    def counters(self) -> dict[str, float]:
        """Return counters of path planning.

        They are `plans` (of legs), `plan_failures`, `replans`, `refusals` (a rolling planner
        requested a run that was not free), `improvements` (plans were replaced by better ones),
        `expansions` (of labels), `cost_tables` (of travel times), and the wall time
        `planning_s` in s. The simulated time `planning_charged_s` that plans took is 0 unless plans
        take time. `motions`, `late_motions`, the total `lateness_s` and `repairs` (plans replaced
        because another robot was late) are 0 unless motions can be late.
        """
        counts: dict[str, float] = dict(self._core.counters())
        counts["planning_s"] = counts.pop("planning_ns") / 1e9
        counts["planning_charged_s"] = counts.pop("charged_us") / 1e6
        counts["lateness_s"] = counts.pop("lateness_us") / 1e6
        return counts

    def plans(self) -> dict[str, NDArray[Any]]:
        """Return the searches for plans of trips since time zero; empty if plans take no time.

        The columns are `robot`, `asked_us`, `begun_us`, `labels`, `took_us`, `found` and the wall
        time `wall_s` of the search.
        """
        return self._core.plans()

    def call_times_s(self) -> NDArray[np.float64]:
        """Return the wall time of each call of the planner since the last reset, in seconds.

        A per-leg planner is called for one robot, a rolling planner for all driving robots.
        """
        return self._core.call_times() / 1e9

    def reset_statistics(self) -> None:
        """Reset totals, heat, edges, trips, counters and call times; the trace is kept."""
        self._core.reset_statistics()

    def state_report(self) -> str:
        """Return one line per robot, for a report in case no robot can move any more."""
        return self._core.state_report()
