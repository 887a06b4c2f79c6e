"""Two short recorded runs that differ in one rule."""

import pytest

import rmfs
from rmfs.measure import RunFolder, load_run, write_run

WARMUP_S, END_S = 60.0, 660.0


@pytest.fixture(scope="session")
def runs(tmp_path_factory: pytest.TempPathFactory) -> list[RunFolder]:
    parent = tmp_path_factory.mktemp("runs")
    return [_recorded(parent / name, name) for name in ("nearest", "random")]


def _recorded(path, rule) -> RunFolder:
    overrides = [
        (["layout", "robots"], 12),
        (["scenario", "warmup_s"], WARMUP_S),
        (["scenario", "duration_s"], END_S - WARMUP_S),
        (["controllers", "psa", "name"], rule),
    ]
    run = rmfs.simulate("default", "default", "default", seed=2, overrides=overrides, trace=True)
    write_run(run, path, trace=True)
    return load_run(path)
