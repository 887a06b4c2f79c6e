"""Whole demonstrations: server and emulated room over TCP, in step."""

import pytest
from laboratory import RADII_M, Laboratory

from rmfs.demonstrator.emulator.unkind import KIND
from rmfs.measure.dictionary import reproducible


def footprint(run):
    return run.footprint[reproducible("footprint")].to_json()


def after(second, act):
    """Return mischief that happens once: when `act` says that it has found its victim."""
    done = []

    def mischief(room):
        if room.now_us >= second * 1e6 and not done and act(room):
            done.append(True)

    return mischief


def driving(room):
    """A robot in the middle of a straight run, or None."""
    for robot in room.robots.values():
        order = robot.program.memory.order if robot.program else None
        if order and order.turned and robot.base._left > 0.15 and robot.base._right > 0.15:
            return robot
    return None


def all_is_well(lab, run, units=1):
    assert lab.room.truth.nearest_m >= RADII_M
    assert run.footprint["units_picked"] >= units
    for robot in lab.demonstration.traffic.guide.robots.values():
        assert not robot.given_up


def test_four_robots_do_what_four_simulated_ones_do(tmp_path):
    """In a room where nothing goes wrong nothing but a little time is lost."""
    lab = Laboratory(tmp_path, KIND)
    run = lab.run(45)
    all_is_well(lab, run, units=2)
    assert run.footprint["bundles_stored"] >= 2
    assert run.footprint["distance_m"] == pytest.approx(lab.room.truth.driven_m, rel=0.05)
    assert lab.room.truth.lateral_mean_m < 0.01
    assert lab.counts["orders"] >= 20
    assert not any(lab.counts[name] for name in lab.counts if name not in ("orders", "delays"))


def test_the_same_seed_gives_the_same_run_in_an_unkind_room(tmp_path):
    runs, truths = [], []
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        lab = Laboratory(tmp_path / folder)
        runs.append(footprint(lab.run(20)))
        truths.append((lab.room.truth.nearest_m, lab.room.truth.driven_m))
    assert runs[0] == runs[1]
    assert truths[0] == truths[1]


def test_some_robots_real_and_some_simulated(tmp_path):
    lab = Laboratory(tmp_path, real="0,2")
    run = lab.run(45)
    all_is_well(lab, run)
    assert list(lab.room.robots) == ["robot-0", "robot-2"]
    driven = run.traffic.motion()["distance_m"]
    assert (driven > 1).all()
    assert driven[[0, 2]].sum() == pytest.approx(lab.room.truth.driven_m, rel=0.1)
