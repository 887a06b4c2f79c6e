"""The robots of one layout: a thin interface to the compiled core."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

from rmfs.traffic.core import Options, build, fork, from_bytes, to_bytes
from rmfs.traffic.readings import Readings
from rmfs.traffic.settings import COST_TABLE_BYTES, TIME_WINDOWS, PlannerSettings
from rmfs.traffic.vocabulary import CutOff, PlannedMove

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout
    from rmfs.traffic._core import Core


_OWN = {"_layout", "_core", "_options", "advance", "command"}


class Traffic(Readings):
    """The robots of one layout.

    Parameters
    ----------
    layout
        The warehouse. A queue is identified by the number of its station among all stations.
    record_trace
        Whether all motion is recorded (see `trace`).
    cost_table_bytes
        Memory for tables of unhindered travel times, in bytes; the least recently used are dropped.
    planner
        Settings of the path planner.
    slow_shares
        Shares of a robot's top speed to which `slow_down` can reduce it.

    Attributes
    ----------
    advance
        Function of a time limit in us. It advances to the next time at which there are events, but
        not beyond the limit, and returns these events as tuples with the fields of `TrafficEvent`.
        A second argument can leave out kinds of events: an integer whose bit k is set if events of
        `EventKind(k)` are not wanted.
    command
        Function that gives a program to a robot; its arguments are the robot and the program. The
        program is a list of pairs of a `Step` and its argument.

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
        self.advance: Callable[..., list[tuple[int, int, int, int]]]
        self.command: Callable[[int, list[tuple[int, int]]], None]
        self.__dict__.update(_of(build(layout, options), options))

    def fork(self, memo: dict[int, Any] | None = None) -> Self:
        """Copy the traffic; given the same commands, the copy and the original stay bit-identical.

        Constant data and past records are shared, so a copy takes milliseconds. A planner written
        in Python is deep-copied. `copy.deepcopy` does the same.

        Parameters
        ----------
        memo
            Memo of the enclosing deep copy.
        """
        copy = type(self).__new__(type(self))
        core, options = fork(self._core, self._options, {} if memo is None else memo)
        copy.__dict__.update({**self.__dict__, **_of(core, options)})
        return copy

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        """Copy the traffic; see `fork`."""
        return self.fork(memo)

    def to_bytes(self) -> bytes:
        """Return the state of the traffic, without the layout, as bytes.

        A planner written in Python is pickled; if that fails, the error is raised.
        """
        return to_bytes(self._core, self._options)

    @classmethod
    def from_bytes(cls, layout: Layout, saved: bytes) -> Self:
        """Restore the traffic from bytes saved by `to_bytes`, on the same layout.

        A planner written in Python is unpickled, which can run arbitrary code: restore only bytes
        that you trust.

        Raises
        ------
        ValueError
            If the bytes are not saved traffic, are damaged, or belong to another version or layout.
        """
        traffic = cls.__new__(cls)
        traffic.__setstate__((layout, saved, {}))
        return traffic

    def __getstate__(self) -> tuple[Layout, bytes, dict[str, Any]]:
        """Return the state for pickling: the layout, the bytes, and what a subclass has added."""
        own = {name: self.__dict__[name] for name in self.__dict__.keys() - _OWN}
        return self._layout, self.to_bytes(), own

    def __setstate__(self, state: tuple[Layout, bytes, dict[str, Any]]) -> None:
        """Restore a pickled state."""
        self._layout, saved, added = state
        self.__dict__.update({**_of(*from_bytes(self._layout, saved)), **added})

    @property
    def now_us(self) -> int:
        """The time up to which traffic has advanced, in microseconds."""
        return self._core.now

    def rest_waypoint(self, robot: int) -> int:
        """Return the waypoint at which a robot's plan ends; without a plan, where it stands."""
        return self._core.rest_waypoint(robot)

    def robot_waypoint(self, robot: int) -> int:
        """Return the next waypoint at which a robot will stop; without a plan, where it stands."""
        return self._core.next_stop(robot)

    def blocked(self) -> list[int]:
        """Return the robots that need to drive but have found no path yet."""
        return self._core.blocked()

    def travel_times_to(self, waypoint: int, loaded: bool, robot: int = 0) -> NDArray[np.float64]:
        """Return unhindered travel times from every waypoint to `waypoint`, from rest to rest.

        Parameters
        ----------
        loaded
            Whether the robot carries a pod.
        robot
            Index of a robot; the times are valid for all robots of its kind.

        Returns
        -------
        Times in s with the best initial heading, shape (N,); infinite if there is no path.
        """
        kind = int(self._layout.robot_kind[robot])
        return self._core.travel_times_to(waypoint, kind, loaded)

    def travel_times_from(self, waypoint: int, loaded: bool, robot: int = 0) -> NDArray[np.float64]:
        """Return unhindered travel times from `waypoint` to every waypoint, from rest to rest.

        Parameters
        ----------
        loaded, robot
            As for `travel_times_to`.

        Returns
        -------
        Times in s with the best initial heading, shape (N,); infinite if there is no path.
        """
        kind = int(self._layout.robot_kind[robot])
        return self._core.travel_times_from(waypoint, kind, loaded)

    def plan(self, robot: int) -> list[PlannedMove]:
        """Return the moves of a robot's plan that have not ended, in their order."""
        return [PlannedMove(*move) for move in self._core.plan(robot)]

    def delay(self, robot: int, by_us: int, *, begun: bool = False) -> bool:
        """Postpone the rest of a robot's plan; the sequence in which robots use waypoints is kept.

        The plans of robots that use a waypoint after this robot are postponed as far as necessary.

        Parameters
        ----------
        robot
            Index of the robot.
        by_us
            Delay in microseconds, not negative.
        begun
            Whether motion in progress may be postponed as well, as is necessary when real robots
            outside the simulation are late.

        Returns
        -------
        Whether the delay was possible; if not, nothing is changed. A delay is impossible if moves
        would have to wait for one another in a circle, or if motion in progress would have to be
        postponed although `begun` is false.
        """
        return self._core.delay(robot, by_us, begun)

    def clearance(self, robot: int) -> list[int]:
        """Return the waypoints ahead of a robot to which it may drive now.

        The waypoints belong to the robot's present straight run or, if the robot stands, to its
        next one, and are in the order of this run. All robots that were to use these waypoints
        earlier have left them.
        """
        return self._core.clearance(robot)

    def regroup(self, rests: Sequence[tuple[int, float, int] | None]) -> None:
        """Discard all plans, set robots to given positions, and replan their programs (`command`).

        Parameters
        ----------
        rests
            For each robot, the waypoint at which it stands or will stop, its heading there in
            radians (the direction of an edge), and the time in microseconds from which it stands
            there. None for a robot that continues its present straight run as far as the path is
            clear.

        Raises
        ------
        ValueError
            If two robots would stand at one waypoint, or a heading or waypoint does not exist;
            then nothing is changed.
        """
        self._core.regroup(list(rests))

    def hold(self, robot: int, by_us: int) -> int | None:
        """Simulate a breakdown: let a robot stand still for `by_us` at its next stop.

        Robots behind it wait for it. All robots keep their paths, and the order in which they use
        waypoints does not change.

        Returns
        -------
        Time at which the robot continues, in microseconds. None if another robot that is already
        driving would have to wait for it; then nothing is changed, and the call can be repeated a
        moment later.
        """
        return self._core.hold(robot, by_us)

    def set_lateness(
        self, probability: float, least_us: int, most_us: int, *, repair: bool, seed: int
    ) -> None:
        """Let motions begin late from now on, each with the same probability.

        A delay is drawn just before a robot turns towards its next straight run, so no plan
        anticipates the delay. Robots behind the late robot wait for it. The order in which robots
        use waypoints can change only with `repair`. A delay that would force a driving robot to
        stop is applied at the late robot's next stop instead.

        Parameters
        ----------
        probability
            Probability that a motion is late.
        least_us, most_us
            Shortest and longest delay in microseconds, uniformly distributed.
        repair
            Whether to replan each robot that has to wait for a late robot for more than a second.
            The waiting robot is replanned alone or, if this does not help, together with the late
            robot, which is then planned second. New plans are kept only if they decrease the sum of
            arrival times. With rolling planners, `repair` has no effect.
        seed
            Seed of the draws, below 2^64.

        Raises
        ------
        ValueError
            If the probability or the delays are invalid; then nothing is changed.
        """
        self._core.set_lateness(probability, least_us, most_us, repair, seed)

    def reseed_lateness(self, seed: int) -> None:
        """Draw the lateness of motions with another seed from now on, if motions can be late."""
        self._core.reseed_lateness(seed)

    def set_pace(
        self,
        price: str,
        numbers: tuple[float, float] = (0.0, 0.0),
        *,
        tape: Sequence[tuple[int, int, int, int]] = (),
        period_us: int = 0,
        lazy: bool = False,
        each: bool = False,
    ) -> None:
        """Let plans of trips take time from now on; a robot departs when its plan is ready.

        This is possible only with trip planners, which plan one trip at a time. A plan is made
        around the reservations that exist when planning begins. The robot departs no earlier than
        the end of the planning time, but its route is reserved as soon as planning begins.

        Parameters
        ----------
        price
            How the planning time is determined: `fixed`, `work`, `wall` or `replay`.
        numbers
            Simulated time that is charged. `fixed`: microseconds per plan. `work`: microseconds per
            search, and per label. `wall`: seconds per second of wall time.
        tape
            For `replay`, the searches of another run, each as (robot, start in us, number of
            labels, time taken in us).
        period_us
            Plans are begun only at multiples of this time; 0: at any time.
        lazy
            Whether a robot asks for a plan only when it could depart; otherwise, it may ask
            earlier, while it lifts a pod.
        each
            Whether each robot has a planner of its own, instead of one planner for all robots.

        Raises
        ------
        ValueError
            If a time is negative, or `price` is unknown; then nothing is changed.
        """
        self._core.set_pace(price, numbers, list(tape), period_us, lazy, each)

    def slow_down(self, robot: int, level: int) -> bool:
        """Reduce the top speed of a robot that stands still, or restore it.

        Parameters
        ----------
        level
            0: the robot's own top speed; k from 1: reduced to the k-th share in `slow_shares`.

        Returns
        -------
        Whether the speed was changed. It is not changed if the robot drives, lifts or sets down a
        pod, or if another robot that is already driving would have to wait for this robot.
        """
        kind = int(self._layout.robot_kind[robot]) + level * len(self._layout.robot_kinds)
        return self._core.change_kind(robot, kind)

    def close(self, waypoints: Sequence[int]) -> list[int]:
        """Close waypoints: no new plan enters them until they are reopened.

        A robot that is on a closed waypoint continues and leaves it, unless it is idle. A robot
        whose plan leads to a closed waypoint gets another plan or, failing that, stops before that
        waypoint and waits; if that is impossible too, it still drives through. Close all waypoints
        of an elevator to put it out of service.

        Parameters
        ----------
        waypoints
            The waypoints; they may already be closed.

        Returns
        -------
        Robots that still drive through a closed waypoint, because they can no longer stop before
        it, or because other robots need every place where they could stop.

        Raises
        ------
        ValueError
            If a waypoint does not exist; then nothing is changed.
        """
        return self._core.close(list(waypoints))

    def reopen(self, waypoints: Sequence[int]) -> None:
        """Reopen closed waypoints.

        Raises
        ------
        ValueError
            If a waypoint does not exist; then nothing is changed.
        """
        self._core.reopen(list(waypoints))

    def cut_off(self) -> CutOff:
        """Return the storage locations and stations that closed waypoints cut off."""
        return CutOff(*self._core.cut_off())

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
            Eleven numbers in the order of `Model` in rmfs/traffic/src/energy.rs: mass of a robot
            (kg), rolling resistance per weight, inertia of rotating parts as a share of the mass,
            efficiency of the drive, share of braking energy that is recuperated, resisting torque
            of turns per weight (m), radius of gyration (m), height (m) and efficiency of a lift,
            standby power without and with a pod (W).
        pods_kg
            Mass of each pod with its stock in kg, shape (P,).
        initial_j
            Initial energy in each battery in J, shape (R,). Default: 0.
        battery
            Capacity (J), and the share of it above which the power of a charger falls.
        power_w
            Power in W that each waypoint supplies to a robot that stands there, shape (N,).
            Default: 0.
        """
        level = [0.0] * self._layout.robots if initial_j is None else list(initial_j)
        self._core.count_energy(list(model), list(pods_kg), battery, list(power_w), level)

    def set_pod_mass(self, pod: int, kg: float) -> None:
        """Set the mass of a pod with its stock, in kg, from now on."""
        self._core.set_pod_mass(pod, kg)

    def set_power(self, waypoint: int, watts: float) -> None:
        """Set the power in W that a waypoint supplies to a robot that stands there."""
        self._core.set_power(waypoint, watts)

    def exchange_battery(self, robot: int, level_j: float) -> None:
        """Give a robot that stands still another battery, which holds `level_j` joules.

        The additional energy counts as charged.
        """
        self._core.exchange_battery(robot, level_j)


def _of(core: Core, options: Options) -> dict[str, Any]:
    """Return the attributes of `Traffic` that belong to a core."""
    return {
        "_core": core,
        "_options": options,
        "advance": core.advance,
        "command": core.command,
    }
