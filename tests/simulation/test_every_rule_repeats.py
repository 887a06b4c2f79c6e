"""The same seed gives the same run, whichever rule is chosen."""

from __future__ import annotations

import pytest
from every_rule import always_busy, rules_of, tables_of

import rmfs
from rmfs.control.problems import Problem
from rmfs.measure.dictionary import reproducible

EVERY_RULE = rules_of(*Problem)


@pytest.mark.parametrize(("problem", "name"), EVERY_RULE, ids=str)
def test_every_event_is_repeated(problem, name) -> None:
    """What is picked, stored, brought and parked, when and by which robot, over half an hour."""

    def log() -> list[tuple]:
        made = always_busy(1800.0, **tables_of(problem, name))
        made.run()
        return made.ledger.log

    first = log()
    assert len(first) > 50
    assert first == log()


@pytest.mark.slow
@pytest.mark.parametrize(("problem", "name"), EVERY_RULE, ids=str)
def test_every_figure_is_repeated(problem, name) -> None:
    """The footprint of an hour with 32 robots that get in each other's way."""

    def figures() -> str:
        overrides = [
            (["scenario", "duration_s"], 3600.0),
            (["scenario", "warmup_s"], 0.0),
            *((["controllers", key], table) for key, table in tables_of(problem, name).items()),
        ]
        run = rmfs.simulate("default", "default", "default", seed=3, overrides=overrides)
        return run.footprint[reproducible("footprint")].to_json()

    assert figures() == figures()
