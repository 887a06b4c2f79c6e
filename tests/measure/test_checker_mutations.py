"""The checker on traces of real runs: it accepts them, and rejects what was spoiled in them.

A spoiled trace need not be unsafe: a robot that starts a little too early may still keep clear of
all others. So the verdict on starts too early is compared with a slow look at sampled positions
that shares no code with the checker.
"""

from __future__ import annotations

import numpy as np
import pytest
from mutations import (
    overlap_m,
    positions,
    started_earlier,
    swapped,
    waits,
    with_pod_in_the_way,
)
from scripted_trace import HOLD, RUN

from rmfs.measure.checker import FindingKind, check
from rmfs.simulation.run import simulate

GREY_M = 2e-3
"""Overlaps smaller than this may fall between two samples."""


@pytest.fixture(scope="module")
def driven():
    run = simulate("basic", "basic", "default", seed=1, trace=True)
    return run.layout, run.trace, round(run.end_s * 1e6)


def kinds(report):
    return {finding.kind for finding in report.findings}


def test_a_real_trace_is_accepted(driven):
    layout, trace, end_us = driven
    report = check(layout, trace, until_us=end_us)
    assert report.ok, report.summary()
    assert report.pieces > 1000
    assert report.pairs > 0


def test_positions_agree_with_the_waypoints(driven):
    """The slow look itself: at the end of every run a robot is where the trace says."""
    layout, trace, _ = driven
    rows = np.flatnonzero((trace["kind"] == RUN) & (trace["robot"] == 3))[:40]
    place = positions(layout, trace, trace["t1_us"][rows] / 1e6)[3]
    assert place[:, 0] == pytest.approx(layout.x_m[trace["to_wp"][rows]], abs=1e-3)
    assert place[:, 1] == pytest.approx(layout.y_m[trace["to_wp"][rows]], abs=1e-3)


@pytest.mark.parametrize("by_s", [0.2, 1.0, 3.0])
def test_starts_too_early_are_judged_as_sampling_does(driven, by_s):
    layout, trace, end_us = driven
    candidates = np.random.default_rng(4).permutation(waits(trace, by_s + 0.1))[:12]
    caught = 0
    for row in candidates.tolist():
        mutant = started_earlier(trace, row, by_s)
        report = check(layout, mutant, until_us=end_us)
        assert kinds(report) <= {FindingKind.ROBOTS_OVERLAP, FindingKind.QUEUE_PLACE_SHARED}
        found = report.of(FindingKind.ROBOTS_OVERLAP)
        begin = mutant["t1_us"][row] / 1e6
        own = np.flatnonzero(mutant["robot"] == mutant["robot"][row])
        after = own[(own > row) & (mutant["kind"][own] == HOLD)]
        end = mutant["t1_us"][after[0] if len(after) else own[-1]] / 1e6
        overlap = overlap_m(layout, mutant, begin, min(end, begin + 60.0), step_s=0.04)
        if abs(overlap) > GREY_M and end < begin + 60.0:
            assert (overlap > 0) == bool(found), (row, overlap)
        caught += bool(found)
    # reservations keep robots further apart than their discs, so a second too early is often safe
    assert by_s < 3.0 or caught >= 3


def test_a_wait_left_out_is_an_overlap_of_the_right_size(driven):
    layout, trace, end_us = driven
    for row in waits(trace, 3.1):
        mutant = started_earlier(trace, row, 3.0)
        found = check(layout, mutant, until_us=end_us).of(FindingKind.ROBOTS_OVERLAP)
        if found:
            moment = found[0].time_s
            sampled = overlap_m(layout, mutant, moment - 0.05, moment + 0.05, step_s=0.001)
            assert found[0].amount == pytest.approx(sampled, abs=1e-3)
            return
    pytest.fail("no such wait")


def test_a_shortened_interval_is_a_gap(driven):
    layout, trace, end_us = driven
    mutant = {name: column.copy() for name, column in trace.items()}
    row = waits(trace, 1.0)[10]
    mutant["t1_us"][row] -= 200_000
    (finding,) = check(layout, mutant, until_us=end_us).findings
    assert finding.kind == FindingKind.GAP
    assert finding.amount == pytest.approx(0.2)


def test_a_run_driven_too_fast_is_noticed(driven):
    layout, trace, end_us = driven
    mutant = {name: column.copy() for name, column in trace.items()}
    rows = np.flatnonzero(trace["kind"] == RUN)
    row = next(k for k in rows if trace["kind"][k + 1] == HOLD)
    mutant["t1_us"][row] -= 200_000
    mutant["t0_us"][row + 1] -= 200_000
    report = check(layout, mutant, until_us=end_us)
    assert FindingKind.DURATION in kinds(report)


def test_swapped_plans_are_noticed(driven):
    layout, trace, end_us = driven
    report = check(layout, swapped(trace, 2, 9, 300.0), until_us=end_us)
    assert FindingKind.JUMP in kinds(report)
    assert {robot for finding in report.of(FindingKind.JUMP) for robot in finding.robots} == {2, 9}


def test_a_robot_driven_through_a_pod_is_noticed(driven):
    layout, trace, end_us = driven
    loaded = np.flatnonzero((trace["kind"] == RUN) & (trace["pod"] >= 0))
    for row in loaded[[5, 50, 100]]:
        spoiled = with_pod_in_the_way(layout, trace, int(row))
        report = check(spoiled, trace, until_us=end_us)
        assert FindingKind.POD_CROSSED in kinds(report)
        assert report.collisions > 0
        places = {finding.place for finding in report.of(FindingKind.POD_CROSSED)}
        assert places == {int(trace["to_wp"][row])}


def test_every_loaded_run_counts(driven):
    """Robots that seem empty pass beneath pods lawfully, so a pod forgotten must be noticed."""
    layout, trace, end_us = driven
    mutant = {name: column.copy() for name, column in trace.items()}
    rows = np.flatnonzero((trace["kind"] == RUN) & (trace["pod"] >= 0))
    mutant["pod"][rows[20]] = -1
    assert FindingKind.POD_HANDLING in kinds(check(layout, mutant, until_us=end_us))
