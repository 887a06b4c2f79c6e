"""24 hours of a three-tier warehouse in which something goes wrong every few minutes."""

import pytest
from ledger import Ledger

import rmfs
from rmfs.measure import tables
from rmfs.observer import Observer
from rmfs.world import verify

DAY_S = 86_400.0
HOUR_S = 3_600.0


class Tasks(Observer):
    """Remembers what each robot was told to do, and when."""

    def run_started(self, simulation):
        self.told = [[] for _ in range(simulation.layout.robots)]

    def task_started(self, time_s, robot, kind, station):
        self.told[robot].append((time_s, kind))

    def stuck(self, trips):
        """Hours in which a robot had something to do, ended no trip, and was told nothing new."""
        moved = {(int(end_s // HOUR_S), robot) for end_s, robot in trips}
        return [
            (hour, robot)
            for hour in range(1, int(DAY_S // HOUR_S))
            for robot, told in enumerate(self.told)
            if (hour, robot) not in moved
            and not any(hour * HOUR_S <= time_s < (hour + 1) * HOUR_S for time_s, _ in told)
            and [kind for time_s, kind in told if time_s < hour * HOUR_S][-1:] not in ([], ["rest"])
        ]


@pytest.mark.slow
def test_a_day_of_breakdowns():
    """129 robots (43 a tier), a breakdown every ten minutes, an elevator out of use for an hour.

    Pods are stored on any tier, so that cabins are busy most of the time. No collision, no order
    lost, no robot stuck.
    """
    ledger, tasks = Ledger(), Tasks()
    overrides = {
        "layout.robots": 43,
        "controllers.psa.name": "random",
        "controllers.psa.prefer_same_tier": False,  # robots ride elevators
        "scenario.duration_s": DAY_S,
        "scenario.disturbances.breakdowns": {"every_s": 600.0, "lasting_s": 120.0},
        "scenario.disturbances.elevators_out": [[1, 8 * HOUR_S, 9 * HOUR_S]],
    }
    run = rmfs.simulate(
        "study-tiers",
        "pp-minimal",
        "default",
        seed=1,
        overrides=[(key.split("."), value) for key, value in overrides.items()],
        observers=[ledger, tasks],
        trace=True,
    )
    assert run.layout.robots == 129
    verify(run.world)
    ledger.check()
    print(run.footprint[["orders_completed", "disturbances", "disturbed_s", "wall_s"]])
    assert 100 < run.footprint["disturbances"] < 200
    assert run.footprint["disturbed_s"] > 100 * 60
    orders = tables.orders(tables.Logs(run.recorder))
    waiting_s = DAY_S - orders.loc[orders["completed_s"].isna(), "assigned_s"]
    assert waiting_s.max() < HOUR_S
    assert run.traffic.motion()["riding_s"].sum() > DAY_S
    trips = run.traffic.trips()
    assert ((trips["t1_us"] - trips["t0_us"]) / 1e6).max() < HOUR_S / 2
    ends = zip(trips["t1_us"].tolist(), trips["robot"].tolist(), strict=True)
    stuck = tasks.stuck([(end_us / 1e6, robot) for end_us, robot in ends])
    assert not stuck, f"(hour, robot): {stuck}"
    report = run.check()
    print(report.summary())
    assert report.ok, report.summary()
