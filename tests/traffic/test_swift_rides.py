"""The swift search where robots wait for elevators."""

from random_tasks import RandomTasks

from rmfs.layout import load
from rmfs.traffic import PlannerSettings


def station_visits(*, swift: bool) -> int:
    planner = PlannerSettings("time-windows", {"labels": 50_000, "swift": swift})
    tasks = RandomTasks(load("study-tiers", [(["robots"], 16)]), 1, planner=planner)
    return len(tasks.run(900).visits)


def test_the_swift_search_leaves_rides_to_the_usual_one() -> None:
    """Planned by the swift search, trips by elevator left a quarter of the visits undone."""
    assert station_visits(swift=True) > 0.9 * station_visits(swift=False)
