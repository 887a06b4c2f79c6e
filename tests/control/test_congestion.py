"""Delay by congestion: counted per region, added up along trips, and used by rules."""

from __future__ import annotations

import numpy as np
import pytest
from doubles import Situation, small_layout

import rmfs
from rmfs.control.pps.criteria import Nearest as NearestPod
from rmfs.control.psa.nearest import Nearest
from rmfs.control.trackers.congestion import DOUBT, KEPT, Congestion
from rmfs.control.trackers.regions import REGION_M, Density, Regions
from rmfs.errors import InputError
from rmfs.layout import load
from rmfs.layout.model import Layout
from rmfs.measure.dictionary import reproducible


def repeatable(run) -> str:
    """Return all columns of the footprint that do not depend on the machine, as text."""
    return run.footprint[reproducible("footprint")].to_json(double_precision=15)


class TestDensity:
    """The floor of the site `small`."""

    @pytest.fixture
    def regions(self) -> Regions:
        return Regions(load("small"))

    def test_each_waypoint_lies_in_one_region(self, regions) -> None:
        layout = load("small")
        assert regions.sums(np.ones(layout.waypoints)).sum() == layout.waypoints
        together = np.flatnonzero(regions.of == regions.of[0])
        assert np.ptp(layout.x_m[together]) < REGION_M
        assert np.ptp(layout.y_m[together]) < REGION_M

    def test_equal_everywhere_it_is_the_distance(self, regions) -> None:
        layout = load("small")
        every = np.arange(layout.waypoints)
        metres = Density(regions, np.full(regions.shape, 1.0)).along(17, every)
        expected = abs(layout.x_m - layout.x_m[17]) + abs(layout.y_m - layout.y_m[17])
        assert metres == pytest.approx(expected, abs=1e-9)

    def test_against_small_steps(self, regions) -> None:
        """Both corners of the rectangle, in steps of a millimetre."""
        layout, rng = load("small"), np.random.default_rng(4)
        per_metre = rng.random(regions.shape)
        density = Density(regions, per_metre)
        x, y = layout.x_m - layout.x_m.min(), layout.y_m - layout.y_m.min()

        def line(ax, ay, bx, by) -> float:
            steps = max(1, round(1000 * (abs(bx - ax) + abs(by - ay))))
            at = (np.arange(steps) + 0.5) / steps
            rows = ((ay + at * (by - ay)) / REGION_M).astype(int)
            columns = ((ax + at * (bx - ax)) / REGION_M).astype(int)
            return per_metre[0, rows, columns].sum() * (abs(bx - ax) + abs(by - ay)) / steps

        for a, b in rng.integers(layout.waypoints, size=(20, 2)):
            corner = line(x[a], y[a], x[b], y[a]) + line(x[b], y[a], x[b], y[b])
            corner += line(x[a], y[a], x[a], y[b]) + line(x[a], y[b], x[b], y[b])
            found = density.along(int(a), np.array([b]))
            assert found == pytest.approx([corner / 2], abs=0.01)


class Counted:
    """A situation in which traffic has counted what the test says.

    By default, eight storage locations at x = 0 to 7 m; regions are 6 m wide, so that 6 and 7 m
    lie in the second.
    """

    def __init__(self, layout: Layout | None = None) -> None:
        self.situation = Situation(layout or small_layout(places=8, pods=4))
        waypoints = self.situation.view.layout.waypoints
        self.visits, self.waiting_s = np.zeros(waypoints, np.int64), np.zeros(waypoints)
        self.situation.traffic.heat = lambda: {
            "visits": self.visits.copy(),
            "waiting_s": self.waiting_s.copy(),
        }

    def pass_by(self, waypoint: int, visits: int, waiting_s: float) -> None:
        self.visits[waypoint] += visits
        self.waiting_s[waypoint] += waiting_s

    def wait(self, seconds: float) -> None:
        self.situation.world.now_s += seconds


class TestCongestion:
    def test_delay_per_passage(self) -> None:
        counted = Counted()
        tracker = counted.situation.view.trackers.get(Congestion)
        counted.pass_by(2, visits=80, waiting_s=50.0)
        counted.wait(59.0)
        assert not tracker.delay_s.any()
        counted.wait(1.0)
        assert tracker.delay_s.flat[tracker.regions.of[2]] == 50.0 / (80 + DOUBT)
        assert tracker.flow_per_h.flat[tracker.regions.of[2]] == 80 * 60.0
        assert tracker.delay_s.flat[tracker.regions.of[7]] == 0.0

    def test_old_counts_are_forgotten(self) -> None:
        counted = Counted()
        tracker = counted.situation.view.trackers.get(Congestion)
        counted.pass_by(2, visits=80, waiting_s=50.0)
        counted.wait(60.0)
        tracker.delay_s  # noqa: B018
        counted.wait(120.0)
        kept = KEPT**2
        expected = 50.0 * kept / (80 * kept + DOUBT)
        assert tracker.delay_s.flat[tracker.regions.of[2]] == pytest.approx(expected)

    def _started_again(self, visits: int, waiting_s: float) -> tuple[Counted, Congestion]:
        """Counts at waypoint 2 that the tracker has read, and that were then set to 0."""
        counted = Counted()
        tracker = counted.situation.view.trackers.get(Congestion)
        counted.pass_by(2, visits=visits, waiting_s=waiting_s)
        counted.wait(60.0)
        tracker.delay_s  # noqa: B018
        counted.visits[:], counted.waiting_s[:] = 0, 0.0
        return counted, tracker

    def test_counts_that_start_again_are_not_subtracted(self) -> None:
        """As at the end of the warm-up."""
        counted, tracker = self._started_again(visits=80, waiting_s=50.0)
        counted.pass_by(2, visits=10, waiting_s=30.0)
        counted.wait(60.0)
        expected = (50.0 * KEPT + 30.0) / (80 * KEPT + 10 + DOUBT)
        assert tracker.delay_s.flat[tracker.regions.of[2]] == pytest.approx(expected)

    def test_even_if_more_was_counted_since_than_before(self) -> None:
        counted, tracker = self._started_again(visits=10, waiting_s=30.0)
        counted.pass_by(7, visits=80, waiting_s=50.0)
        counted.wait(60.0)
        delay_s = tracker.delay_s.flat
        assert delay_s[tracker.regions.of[2]] == 30.0 * KEPT / (10 * KEPT + DOUBT)
        assert delay_s[tracker.regions.of[7]] == 50.0 / (80 + DOUBT)

    def test_a_forecast_looks_where_robots_go(self) -> None:
        counted = Counted()
        tracker = counted.situation.view.trackers.get(Congestion, "forecast")
        counted.pass_by(2, visits=80, waiting_s=50.0)
        counted.wait(60.0)
        calm = tracker.delay_s.flat[tracker.regions.of[2]]
        robot = counted.situation.world.robots[0]
        robot.waypoint = 7 if counted.situation.traffic.robot_waypoint(0) != 7 else 0
        counted.wait(10.0)
        assert tracker.delay_s.flat[tracker.regions.of[2]] > calm > 0.0

    @pytest.mark.parametrize(
        ("start", "goal", "expected"),
        [
            (0, 23, [[1.0, 0.5, 0.5, 0.5], [0.5, 0.5, 0.5, 1.0]]),
            (19, 21, [[0.5, 0.5, 0.5, 1.0], [1.0, 0.5, 0.5, 0.5]]),
            (0, 13, [[1.0, 1.0, 1.0, 0.0], [0.0, 0.0, 0.0, 0.0]]),
            (0, 21, [[1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]),
            (7, 8, [[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]]),
        ],
    )
    def test_a_robot_counts_once_in_each_region_of_a_route(self, start, goal, expected) -> None:
        """Half a robot on each of two routes: both ways around, along x, along y, in one region.

        Regions are 6 m wide. Storage locations 0 to 19 are at x = 0 to 19 m and y = 0, pick
        stations 21 and 23 at x = 0 and 20 m and y = 10 m.
        """
        situation = Counted(small_layout(places=20, robots=1, pick_stations=3)).situation
        robot = situation.world.robots[0]
        situation.traffic.robot_waypoint = lambda _: start
        robot.waypoint = goal
        tracker = situation.view.trackers.get(Congestion, "forecast")
        assert tracker._robots_through()[0].tolist() == expected

    def test_from_a_table(self, tmp_path) -> None:
        counted = Counted()
        waypoints = len(counted.visits)
        path = tmp_path / "heat.csv"
        rows = [f"{at},{80 * (at == 2)},{50.0 * (at == 2)}" for at in range(waypoints)]
        path.write_text("\n".join(["waypoint,visits,waiting_s", *rows]))
        tracker = counted.situation.view.trackers.get(Congestion, str(path))
        counted.pass_by(7, visits=80, waiting_s=50.0)
        counted.wait(600.0)
        assert tracker.delay_s.flat[tracker.regions.of[2]] == 0.5
        assert tracker.delay_s.flat[tracker.regions.of[7]] == 0.0

    @pytest.mark.parametrize(
        ("text", "says"),
        [
            (None, "must be the table heat of a run"),
            ("waypoint,visits\n0,1\n", "waiting_s"),
            ("waypoint,visits,waiting_s\n0,1,2\n", "a row for each of the"),
            ("many", "finite and not negative"),
        ],
    )
    def test_a_table_that_is_none(self, tmp_path, text, says) -> None:
        counted = Counted()
        path = tmp_path / "heat.csv"
        if text == "many":
            rows = [f"{at},1,-1.0" for at in range(len(counted.visits))]
            text = "\n".join(["waypoint,visits,waiting_s", *rows])
        if text is not None:
            path.write_text(text)
        with pytest.raises(InputError, match=says) as error:
            counted.situation.view.trackers.get(Congestion, str(path))
        assert "heat.csv" in str(error.value)


class TestRules:
    def test_psa_drives_on_where_others_wait(self) -> None:
        """From x = 10 the nearest empty place is at 7 m; with delay there, it is left free."""
        counted = Counted()
        counted.situation.carry(robot=0, pod=1, station=0)
        counted.situation.world.end_task(counted.situation.world.robots[0])
        robot = counted.situation.world.robots[0]
        plain = counted.situation.make(Nearest)
        careful = counted.situation.make(Nearest, congestion=1.0)
        assert careful.place(robot) == plain.place(robot)
        counted.pass_by(plain.place(robot), visits=1, waiting_s=1e5)
        counted.wait(60.0)
        assert careful.place(robot) != plain.place(robot)

    @pytest.mark.parametrize("model", [Nearest.parameters_model, NearestPod])
    def test_metres_and_seconds_are_not_added(self, model) -> None:
        with pytest.raises(ValueError, match="needs metric = 'time'"):
            model(metric="path", congestion=1.0)
        assert model(metric="path").metric == "path"

    @pytest.mark.parametrize("source", ["recent", "forecast"])
    @pytest.mark.parametrize(
        ("controllers", "problem"), [("default", "psa"), ("ta-matching", "ta")]
    )
    def test_runs_change_repeat_and_fork(self, controllers, problem, source) -> None:
        given = {"layout.robots": 8, "scenario.duration_s": 900, "scenario.warmup_s": 300}
        knows = {
            f"controllers.{problem}.congestion": 3.0,
            f"controllers.{problem}.congestion_from": source,
        }
        plain = rmfs.simulate("small", "small", controllers, seed=3, set=given)
        one = rmfs.Simulation("small", "small", controllers, seed=3, set=given | knows)
        one.run_until(700.0)
        other = one.fork()
        one.run()
        other.run()
        again = rmfs.simulate("small", "small", controllers, seed=3, set=given | knows)
        found = {repeatable(run) for run in (one.result(), other.result(), again)}
        assert len(found) == 1
        assert repeatable(plain) not in found
