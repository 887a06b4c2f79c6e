"""The trace of a demonstration: proven from the files, and near to where the robots really were."""

import numpy as np
import pytest
from laboratory import Laboratory
from test_demonstrator_trouble import driving

from rmfs.layout import load
from rmfs.measure.audit import audit
from rmfs.measure.checker import FindingKind
from rmfs.traffic import Piece

SECONDS = 60.0


class Watch:
    """Notes where robots really are, twice a second."""

    def __init__(self):
        self.seen = []

    def __call__(self, room):
        if room.now_us % 500_000 == 0:
            for robot in room.robots.values():
                base = robot.base
                self.seen.append((robot.name, room.now_us, base.x_m, base.y_m))


def to_way(layout, row, x, y):
    """Distance of a place from the way of a row of the trace, m."""
    a, b = int(row.from_wp), int(row.to_wp)
    ax, ay = layout.x_m[a], layout.y_m[a]
    dx, dy = layout.x_m[b] - ax, layout.y_m[b] - ay
    square = dx * dx + dy * dy
    share = np.clip(((x - ax) * dx + (y - ay) * dy) / square, 0, 1) if square else 0.0
    return np.hypot(x - ax - share * dx, y - ay - share * dy)


@pytest.mark.parametrize("real", [None, "0,2"])
def test_the_files_prove_a_demonstration_and_say_where_robots_were(tmp_path, real):
    watch = Watch()
    lab = Laboratory(tmp_path, real=real, mischief=watch)
    run = lab.run(SECONDS, trace=True).save(tmp_path / "run")
    found = audit(run)
    assert found.ok, found.summary()
    trace, layout = run.trace, run.layout
    guided = trace[trace["kind"] == Piece.GUIDED]
    assert set(lab.robots.values()) <= set(guided["robot"])
    # at most one waypoint ahead of what the server had heard, and never behind
    off = []
    for robot, now_us, x, y in watch.seen:
        if now_us >= SECONDS * 1e6:
            continue
        mine = trace[(trace["robot"] == lab.robots[robot]) & (trace["t1_us"] > now_us)].head(2)
        off.append(min(to_way(layout, row, x, y) for row in mine.itertuples()))
    print(len(off), np.max(off), np.quantile(off, [0.5, 0.99]))
    assert len(off) > 100
    assert np.max(off) < 0.1


def test_a_robot_that_was_carried_away_is_found_out(tmp_path):
    """Where it was put is not where a way led, and all else is proven all the same."""
    done, layout = [], load("demonstrator")

    def carry(room):
        robot = driving(room)
        if room.now_us > 15_000_000 and not done and robot is not None:
            others = [r.base for r in room.robots.values() if r is not robot]
            for place in range(layout.waypoints):
                x, y = layout.x_m[place], layout.y_m[place]
                away = np.hypot(x - robot.base.x_m, y - robot.base.y_m)
                free = min(np.hypot(o.x_m - x, o.y_m - y) for o in others) > 1.0
                if (
                    free
                    and 0.6 < away < 1.0
                    and abs(x - robot.base.x_m) > 0.2 < abs(y - robot.base.y_m)
                ):
                    robot.base.x_m, robot.base.y_m = float(x), float(y)
                    done.append(robot)
                    return

    lab = Laboratory(tmp_path, mischief=carry)
    run = lab.run(SECONDS, trace=True).save(tmp_path / "run")
    assert done
    assert lab.counts["strayed"] > 0
    found = audit(run)
    print(found.summary())
    assert found.motion.of(FindingKind.EDGE)
    assert {finding.robots for finding in found.motion.findings} == {(lab.robots[done[0].name],)}
    assert not any(chapter.faults for chapter in found.chapters)
