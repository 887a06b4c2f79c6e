"""Forks of runs of 32 and 128 robots at 200 random moments, with rules and with optimisers."""

from __future__ import annotations

import random
from typing import Any

import pytest
from test_stepping import told

import rmfs
from rmfs.measure.dictionary import reproducible

MOMENTS = 50
GIVEN = {"layout.pod_capacity": 500.0, "scenario.warmup_s": 60, "scenario.duration_s": 180}


def ended(run: rmfs.Simulation) -> dict[str, Any]:
    """Go on to the end; what the run leaves behind, all that is reproducible of its footprint."""
    run.run()
    footprint = run.result().footprint[reproducible("footprint")]
    return {**told(run), "footprint": footprint.to_json(double_precision=15)}


@pytest.mark.slow
@pytest.mark.parametrize("controllers", ["default", "pile-on"])
@pytest.mark.parametrize("layout", ["study-32", "study-128"])
def test_a_fork_ends_as_the_original(layout: str, controllers: str) -> None:
    run = rmfs.Simulation(
        layout, "default", controllers, seed=8, set=GIVEN, pacing="work", trace=True
    )
    draw, ends = random.Random(f"{layout} {controllers}"), []
    for time_s in sorted(draw.uniform(0.0, 240.0) for _ in range(MOMENTS)):
        run.run_until(time_s)
        ends.append(ended(run.fork()))
    end = ended(run)
    assert end["units"] > 0
    assert ends == [end] * MOMENTS
