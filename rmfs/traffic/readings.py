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

        The distances are `distance_m` and `loaded_distance_m` (the part with a pod). The times
        `moving_s`, `turning_s`, `waiting_s` (standing on the way), `served_s` (standing at a
        station), `idle_s`, `transfer_s` (lifting, setting down) and `riding_s` (elevators) add up
        to the elapsed time. `queueing_s`, the time from entering a queue zone to reaching the
        station, overlaps with them; `awaiting_plan_s`, the time in which the robot stands because
        its plan is not ready, is part of `waiting_s`.
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
        """Return how often robots reached waypoints, and how long they stood there.

        Counts start at the last reset; the time for which idle robots stand is not counted. Columns
        with one entry per waypoint, shape (N,), are `visits` (robots that passed or stopped),
        `waiting_s` and, counting only robots with a pod, `loaded_visits` and `loaded_waiting_s`.

        Columns with one entry for each pair of waypoint and purpose that occurred are
        `stays_waypoint`, `stays_purpose`, `stays_visits` and `stays_waiting_s`. The purpose is the
        number of the station for which a robot works, even while the robot still fetches the pod.
        If a robot stores a pod, or fetches one that is not for a station, the purpose is S, the
        number of stations; in all other cases, it is S + 1.
        """
        counted: dict[str, NDArray[Any]] = self._core.heat()
        at, waypoints = counted["stays_waypoint"], len(counted["loaded_visits"])
        visits = np.bincount(at, counted["stays_visits"], waypoints).astype(np.int64)
        waiting_s = np.bincount(at, counted["stays_waiting_s"], waypoints)
        return {"visits": visits, "waiting_s": waiting_s, **counted}

    def edges(self) -> dict[str, NDArray[Any]]:
        """Return the edges and elevator rides used since the last reset, by their end points.

        The columns are `from_wp`, `to_wp`, `passages` (number of uses) and `loaded_passages`
        (number of uses with a pod).
        """
        return self._core.edges()

    def trips(self) -> dict[str, NDArray[Any]]:
        """Return the trips finished since the last reset, in the order in which they finished.

        The columns are `robot`, `kind` (`TripKind`), `t0_us`, `t1_us`, `from_wp`, `to_wp`,
        `loaded`, `distance_m`, `unhindered_s` (lower bound of the duration), `energy_j` (0 if
        energy is not counted) and `awaited_s` (how long the robot waited for its plan at the
        beginning). A trip to a station is finished when the robot reaches the station. Its distance
        and energy include the part in the queue; but `t1_us` is the time at which the robot entered
        the queue zone, and `unhindered_s` refers to the path up to this zone.
        """
        return self._core.trips()

    def trace(self) -> dict[str, NDArray[Any]]:
        """Return the recorded motion so far, in rows sorted by robot and time.

        The columns are `robot`, `t0_us`, `t1_us`, `kind` (`Piece`), `from_wp`, `to_wp`,
        `heading0_rad`, `heading1_rad`, `pod` (the carried pod; -1 if none), `top_speed_m_s`.

        Raises
        ------
        ValueError
            If the trace is not recorded.
        """
        return joined_holds(self._core.trace(0)[0])

    def trace_after(self, known: int) -> tuple[dict[str, NDArray[Any]], int]:
        """Follow a run: return the part of the trace that previous calls have not returned.

        The motion that each robot is currently executing is included, and is returned again until
        it has ended. A row therefore replaces whatever earlier calls returned for the same robot
        from the row's `t0_us` on. If a robot stands still during several calls, it gets several
        consecutive rows, which `joined_holds` merges.

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
        """Return counters of path planning since the last reset.

        The counters are `plans` (trips for which a path was planned), `plan_failures`, `replans`,
        `refusals` (paths of a rolling planner that were discarded because not even their first
        straight run was free), `improvements` (plans replaced by better ones), `expansions` (labels
        expanded), `cost_tables` (tables of travel times computed since time zero), and the wall
        time `planning_s` in s. `planning_charged_s`, the simulated time in s that plans took, is 0
        unless `Traffic.set_pace` was called. `motions`, `late_motions`, `lateness_s` (the total
        delay of late motions in s) and `repairs` (plans replaced because another robot was late)
        are 0 unless `Traffic.set_lateness` was called.
        """
        counts: dict[str, float] = dict(self._core.counters())
        counts["planning_s"] = counts.pop("planning_ns") / 1e9
        counts["planning_charged_s"] = counts.pop("charged_us") / 1e6
        counts["lateness_s"] = counts.pop("lateness_us") / 1e6
        return counts

    def plans(self) -> dict[str, NDArray[Any]]:
        """Return the searches for plans of trips since time zero; none without `Traffic.set_pace`.

        The columns are `robot`, `asked_us` (when the robot asked for a plan), `begun_us` (when the
        planner began the search), `labels`, `took_us` (simulated time that the search took),
        `found` and `wall_s` (wall time of the search).
        """
        return self._core.plans()

    def call_times_s(self) -> NDArray[np.float64]:
        """Return the wall time of each call of the planner since the last reset, in seconds.

        A trip planner is called for one robot, a rolling planner for all driving robots.
        """
        return self._core.call_times() / 1e9

    def reset_statistics(self) -> None:
        """Restart all statistics except those that count from time zero; the trace is kept."""
        self._core.reset_statistics()

    def state_report(self) -> str:
        """Return one line per robot, for a report in case no robot can move any more."""
        return self._core.state_report()
