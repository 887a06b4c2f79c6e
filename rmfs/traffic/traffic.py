"""The robots of one layout: a thin face of the compiled core."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from rmfs.traffic.core import Options, build, fork, from_bytes, to_bytes
from rmfs.traffic.settings import COST_TABLE_BYTES, TIME_WINDOWS, PlannerSettings
from rmfs.traffic.trace import joined_holds
from rmfs.traffic.vocabulary import CutOff, PlannedMove

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from rmfs.layout.model import Layout
    from rmfs.traffic._core import Core


_OWN = {"_layout", "_core", "_options", "advance", "command"}


class Traffic:
    """The robots of one layout.

    Parameters
    ----------
    layout
        The warehouse; its stations' common numbering names the queues.
    record_trace
        Whether every piece of motion is kept (see `trace`).
    cost_table_bytes
        Memory for tables of unhindered times; the least recently used are dropped.
    planner
        Who plans the ways.
    slow_shares
        Shares of its top speed to which a robot may be slowed down.

    Raises
    ------
    ValueError
        If two robots start at one waypoint, a waypoint has two edges in one direction, or the core
        has no such planner.
    """

    def __init__(
        self,
        layout: Layout,
        *,
        record_trace: bool = False,
        cost_table_bytes: int = COST_TABLE_BYTES,
        planner: PlannerSettings = TIME_WINDOWS,
        slow_shares: Sequence[float] = (),
    ) -> None:
        options = Options(record_trace, cost_table_bytes, planner, tuple(slow_shares))
        self._layout = layout
        self._core: Core
        self._options: Options
        # the two calls of the hot path, without a frame in between
        self.advance: Callable[[int], list[tuple[int, int, int, int]]]
        self.command: Callable[[int, list[tuple[int, int]]], None]
        self.__dict__.update(_of(build(layout, options), options))

    def fork(self, memo: dict[int, Any] | None = None) -> Self:
        """Copy the traffic: both go on independently, and bit for bit alike if told the same.

        What never changes is shared, and what has been recorded so far; so a copy costs
        milliseconds. A planner written in Python is copied deeply. `copy.deepcopy` does the same.

        Parameters
        ----------
        memo
            Of the deep copy of which this is a part.
        """
        copy = type(self).__new__(type(self))
        core, options = fork(self._core, self._options, {} if memo is None else memo)
        copy.__dict__.update({**self.__dict__, **_of(core, options)})
        return copy

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        """Fork."""
        return self.fork(memo)

    def to_bytes(self) -> bytes:
        """Save the traffic as it is, without the layout; a planner written in Python is pickled.

        Raises
        ------
        ValueError
            If the planner cannot be written down.
        """
        return to_bytes(self._core, self._options)

    @classmethod
    def from_bytes(cls, layout: Layout, saved: bytes) -> Self:
        """Go on from what `to_bytes` has saved, on the same layout.

        A planner written in Python is unpickled, which can run any code: only load what you trust.

        Raises
        ------
        ValueError
            If these are not such bytes, are damaged, or are those of another version or layout.
        """
        traffic = cls.__new__(cls)
        traffic.__setstate__((layout, saved, {}))
        return traffic

    def __getstate__(self) -> tuple[Layout, bytes, dict[str, Any]]:
        """For pickles: the layout, the bytes, and what a subclass has added."""
        own = {name: self.__dict__[name] for name in self.__dict__.keys() - _OWN}
        return self._layout, self.to_bytes(), own

    def __setstate__(self, state: tuple[Layout, bytes, dict[str, Any]]) -> None:
        """Go on from a pickle."""
        self._layout, saved, added = state
        self.__dict__.update({**_of(*from_bytes(self._layout, saved)), **added})

    @property
    def now_us(self) -> int:
        """The time up to which traffic has advanced, in microseconds."""
        return self._core.now

    def rest_waypoint(self, robot: int) -> int:
        """Where the robot stands, or where its plan ends."""
        return self._core.rest_waypoint(robot)

    def robot_waypoint(self, robot: int) -> int:
        """Where the robot stands, or the next waypoint at which it stops."""
        return self._core.next_stop(robot)

    def blocked(self) -> list[int]:
        """Robots that want to drive and have found no way yet."""
        return self._core.blocked()

    def travel_times_to(self, waypoint: int, loaded: bool, robot: int = 0) -> NDArray[np.float64]:
        """Unhindered times from every waypoint to one, from rest to rest, best start heading.

        Returns
        -------
        Seconds, shape (N,); infinite where there is no way.
        """
        kind = int(self._layout.robot_kind[robot])
        return self._core.travel_times_to(waypoint, kind, loaded)

    def travel_times_from(self, waypoint: int, loaded: bool, robot: int = 0) -> NDArray[np.float64]:
        """Unhindered times from one waypoint to every other, from rest to rest, any start heading.

        Returns
        -------
        Seconds, shape (N,); infinite where there is no way.
        """
        kind = int(self._layout.robot_kind[robot])
        return self._core.travel_times_from(waypoint, kind, loaded)

    def plan(self, robot: int) -> list[PlannedMove]:
        """Pieces of motion a robot will do, from rest to rest, the present one included."""
        return [PlannedMove(*move) for move in self._core.plan(robot)]

    def delay(self, robot: int, by_us: int, *, begun: bool = False) -> bool:
        """Shift what is left of a robot's plan; the order in which waypoints are used stays.

        Whoever is to use a waypoint after this robot enters it later if need be, and so on.

        Parameters
        ----------
        robot
            Whose plan.
        by_us
            Microseconds, not negative.
        begun
            Whether motion in progress may be shifted too, as it must be when robots outside the
            simulation are late. Otherwise nothing happens if that would be needed.

        Returns
        -------
        Whether the plans were shifted.
        """
        return self._core.delay(robot, by_us, begun)

    def clearance(self, robot: int) -> list[int]:
        """Waypoints of the robot's present or next run, not passed, that it may drive to at once.

        In order; whoever was to use them before has left them.
        """
        return self._core.clearance(robot)

    def regroup(self, rests: Sequence[tuple[int, float, int] | None]) -> None:
        """Give up plans, put the robots where they really are, and plan their programs anew.

        Parameters
        ----------
        rests
            For each robot the waypoint at which it stands or will stop, its heading in radians
            (that of an edge), and the time it stands there, in microseconds. None for a robot that
            keeps the run it is in the middle of, as far as the way is clear.

        Raises
        ------
        ValueError
            If two robots would have one waypoint, or a heading or waypoint does not exist; nothing
            has changed then.
        """
        self._core.regroup(list(rests))

    def hold(self, robot: int, by_us: int) -> int | None:
        """Let a robot stand still for a while where it next comes to rest: a breakdown.

        Others who are to use a waypoint after it wait; all keep their ways and their order.

        Returns
        -------
        When it goes on, in microseconds; None, and nothing has changed, if somebody is already
        driving who would have to wait: try again a moment later.
        """
        return self._core.hold(robot, by_us)

    def set_lateness(
        self, probability: float, least_us: int, most_us: int, *, repair: bool, seed: int
    ) -> None:
        """Let motions begin late from now on, each with the same probability.

        It is drawn just before a robot turns for a run, so that no plan knows of it. Others who are
        to use a waypoint after the robot wait; all keep their order, unless that is repaired. A
        delay for which somebody would have to stop who is driving comes at the robot's next stop.

        Parameters
        ----------
        probability
            Of a motion to be late.
        least_us, most_us
            Shortest and longest delay; all between are equally likely.
        repair
            Whether those who are made to wait are planned again, alone or in front of the robot
            that is late, if that is better for both.
        seed
            What is drawn with: below 2^64.

        Raises
        ------
        ValueError
            If the probability or the delays cannot be; nothing has changed then.
        """
        self._core.set_lateness(probability, least_us, most_us, repair, seed)

    def reseed_lateness(self, seed: int) -> None:
        """Draw with another seed from now on; nothing happens if motions are never late."""
        self._core.reseed_lateness(seed)

    def slow_down(self, robot: int, level: int) -> bool:
        """Let a robot that stands still drive slower from now on, or as fast as it should again.

        Parameters
        ----------
        level
            0 for its own top speed, k for the k-th of `slow_shares`.

        Returns
        -------
        Whether that was done; not if the robot is in motion, or somebody is already driving who
        would have to wait for it.
        """
        kind = int(self._layout.robot_kind[robot]) + level * len(self._layout.robot_kinds)
        return self._core.change_kind(robot, kind)

    def close(self, waypoints: Sequence[int]) -> list[int]:
        """Close waypoints from now on: nobody enters them until they are opened again.

        Who is on one, or can no longer stop before it, goes on and leaves; whose plan leads there
        later gets another, or stops before it and waits. A robot that stands there without anything
        to do stays. Close all waypoints of an elevator to put it out of service.

        Parameters
        ----------
        waypoints
            Which; may be closed already.

        Returns
        -------
        Robots that still drive through one: they cannot stop, or every place where they could is
        needed by others.

        Raises
        ------
        ValueError
            If a waypoint does not exist; nothing has changed then.
        """
        return self._core.close(list(waypoints))

    def reopen(self, waypoints: Sequence[int]) -> None:
        """Open closed waypoints again.

        Raises
        ------
        ValueError
            If a waypoint does not exist; nothing has changed then.
        """
        self._core.reopen(list(waypoints))

    def cut_off(self) -> CutOff:
        """Say what cannot be served with what is closed: robots bound there would wait."""
        return CutOff(*self._core.cut_off())

    def motion(self) -> dict[str, NDArray[Any]]:
        """Totals per robot since the last reset, up to now, each of shape (R,).

        `distance_m`, `loaded_distance_m`; the times `moving_s`, `turning_s`, `waiting_s` (standing
        with a way to go), `served_s` (standing at a station), `idle_s`, `transfer_s` (lifting,
        setting down) and `riding_s` (elevators) add up to the time passed; `queueing_s` counts from
        entering a queue zone to reaching the station and overlaps with the others.
        """
        return self._core.motion()

    def count_energy(
        self,
        model: Sequence[float],
        pods_kg: Sequence[float],
        *,
        initial_j: Sequence[float] | None = None,
        battery: tuple[float, float] | None = None,
        power_w: Sequence[float] = (),
    ) -> None:
        """Count energy from now on.

        Parameters
        ----------
        model
            Eleven numbers in the order of `Model` in src/energy.rs: kg of a robot, rolling
            resistance per weight, share that turning parts add to inertia, efficiency of the drive,
            share of the work of braking that comes back, torque against turning per weight (m),
            radius of gyration (m), height (m) and efficiency of a lift, W without and with a pod.
        pods_kg
            Mass of each pod with its stock, shape (P,).
        initial_j
            What is in each battery, shape (R,). Default: 0.
        battery
            Capacity (J), and the share of it from which the power of a charger falls.
        power_w
            What each waypoint gives to a robot that stands there, shape (N,). Default: nothing.
        """
        level = [0.0] * self._layout.robots if initial_j is None else list(initial_j)
        self._core.count_energy(list(model), list(pods_kg), battery, list(power_w), level)

    def energy(self) -> dict[str, NDArray[Any]]:
        """Energy per robot, up to now, each of shape (R,).

        Since the last reset, in J: `drive_j`, `turn_j`, `lift_j`, `standby_j`, less
        `recuperated_j` make `used_j`; `charged_j`, and `charging_s`. Since time zero: `initial_j`
        + `ever_charged_j` - `ever_used_j` = `level_j`.

        Raises
        ------
        ValueError
            If energy is not counted.
        """
        return self._core.energy()

    def used_j(self, robot: int) -> float:
        """Energy drawn by a robot since time zero, J."""
        return self._core.used(robot)

    def level_j(self, robot: int) -> float:
        """Energy in the battery of a robot, J."""
        return self._core.level(robot)

    def set_pod_mass(self, pod: int, kg: float) -> None:
        """Say what a pod weighs with its stock from now on."""
        self._core.set_pod_mass(pod, kg)

    def set_power(self, waypoint: int, watts: float) -> None:
        """Let a waypoint give another power to a robot that stands there."""
        self._core.set_power(waypoint, watts)

    def exchange_battery(self, robot: int, level_j: float) -> None:
        """Give a robot that stands still another battery; the difference counts as charged."""
        self._core.exchange_battery(robot, level_j)

    def heat(self) -> dict[str, NDArray[Any]]:
        """Count visits and standing time of robots that are not idle, since the last reset.

        Per waypoint, shape (N,): `visits`, `waiting_s`, and of these with a pod `loaded_visits`,
        `loaded_waiting_s`. A row for each waypoint and purpose for which robots were there, shape
        (M,): `stays_waypoint`, `stays_purpose`, `stays_visits`, `stays_waiting_s`. The purpose is
        the station a robot is bound for or stands at (on the way to the pod, too), S for storing or
        fetching a pod otherwise, S + 1 for the rest.
        """
        counted: dict[str, NDArray[Any]] = self._core.heat()
        at, waypoints = counted["stays_waypoint"], len(counted["loaded_visits"])
        visits = np.bincount(at, counted["stays_visits"], waypoints).astype(np.int64)
        waiting_s = np.bincount(at, counted["stays_waiting_s"], waypoints)
        return {"visits": visits, "waiting_s": waiting_s, **counted}

    def edges(self) -> dict[str, NDArray[Any]]:
        """Edges and elevator rides used since the last reset, by their ends.

        `from_wp`, `to_wp`, `passages`, and of these `loaded_passages` with a pod.
        """
        return self._core.edges()

    def trips(self) -> dict[str, NDArray[Any]]:
        """Trips finished since the last reset, in order of their end.

        `robot`, `kind` (`TripKind`), `t0_us`, `t1_us` (a trip to a station ends at its queue
        zone), `from_wp`, `to_wp`, `loaded`, `distance_m`, `unhindered_s` (lower bound of the
        time from rest to rest), `energy_j` (0 if energy is not counted).
        """
        return self._core.trips()

    def trace(self) -> dict[str, NDArray[Any]]:
        """Every piece of motion so far, sorted by robot and time.

        `robot`, `t0_us`, `t1_us`, `kind` (`Piece`), `from_wp`, `to_wp`, `heading0_rad`,
        `heading1_rad`, `pod` (carried, -1 without).

        Raises
        ------
        ValueError
            If the trace is not recorded.
        """
        return joined_holds(self._core.trace(0)[0])

    def trace_after(self, known: int) -> tuple[dict[str, NDArray[Any]], int]:
        """The trace without what is known of it already: for who follows a run as it goes.

        The motion each robot is in the middle of is among the rows, and comes again as long as it
        lasts: a row takes the place of what was known of its robot from `t0_us` on. Where a robot
        stood while this was called, several rows follow each other (`joined_holds`).

        Parameters
        ----------
        known
            The number returned by the call before; 0 at first.

        Returns
        -------
        tuple
            The columns of `trace`, and the number to give next time.

        Raises
        ------
        ValueError
            If the trace is not recorded.
        """
        return self._core.trace(known)

    def counters(self) -> dict[str, float]:
        """Count the work of planning.

        `plans` (legs), `plan_failures`, `replans`, `refusals` (runs a rolling planner wanted that
        were not free), `improvements`, `expansions`, `cost_tables`, and wall time, `planning_s`.
        Where motions can be late: `motions`, `late_motions`, `lateness_s` in all, and `repairs`.
        """
        counts: dict[str, float] = dict(self._core.counters())
        counts["planning_s"] = counts.pop("planning_ns") / 1e9
        counts["lateness_s"] = counts.pop("lateness_us") / 1e6
        return counts

    def call_times_s(self) -> NDArray[np.float64]:
        """Wall time of each call of the planner since the last reset, in seconds.

        A planner per leg is called for one robot, a rolling one for all that drive.
        """
        return self._core.call_times() / 1e9

    def reset_statistics(self) -> None:
        """Forget totals, heat, trips and counters; the trace stays whole."""
        self._core.reset_statistics()

    def state_report(self) -> str:
        """One line per robot, for a report when nothing can move any more."""
        return self._core.state_report()


def _of(core: Core, options: Options) -> dict[str, Any]:
    """What of traffic is the core's."""
    return {
        "_core": core,
        "_options": options,
        "advance": core.advance,
        "command": core.command,
    }
