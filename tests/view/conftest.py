"""Two short recorded runs that differ in one rule, and pages in Chromium."""

from collections.abc import Iterator
from typing import Any

import pytest

import rmfs
from rmfs.measure import RunFolder, load_run, write_run
from tests.tools.viewer.chromium import chromium, open_page

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


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    with chromium() as made:
        yield made


@pytest.fixture
def page(browser: Any) -> Iterator[Any]:
    """A page that must not complain."""
    # asking the page things from outside needs what its policy forbids
    made = open_page(browser, viewport={"width": 1100, "height": 700}, bypass_csp=True)
    complaints: list[str] = []
    made.on("console", lambda m: complaints.append(m.text) if m.type == "error" else None)
    made.on("pageerror", lambda error: complaints.append(str(error)))
    yield made
    made.close()
    assert complaints == []
