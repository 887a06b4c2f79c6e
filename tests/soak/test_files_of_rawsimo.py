"""Every published file of RAWSim-O runs for half an hour, or is refused for the reason given here.

A file stands in for its part of a run; the other parts are shipped ones. The table of what each
handled is printed (`pytest -s`) and written to results/files-of-rawsimo.md.
"""

from __future__ import annotations

from pathlib import Path

import pytest

import rmfs
from rmfs.errors import InputError
from rmfs.files import write_text
from rmfs.measure.checker import check

pytestmark = pytest.mark.slow

REFERENCE = Path(__file__).resolve().parents[3] / "shared" / "reference" / "instances"
PLACES = {".xinst": 0, ".xlayo": 0, ".xsett": 1, ".xconf": 2}
PARTS = {**PLACES, ".xgenc": None, ".xitem": None, ".txt": None}
FILES = sorted(
    path
    for path in REFERENCE.rglob("*")
    if path.suffix in PARTS and not path.name.startswith("LICENSE")
)

ISOLATED = r"no aisle leads to the entrance of its queue"
REFUSED = {
    "demonstrator/desk.xinst": ISOLATED,
    "generated/d-two-directional.xinst": ISOLATED,
}
"""Layouts that are not well-formed, and what is said of them."""

HALF_AN_HOUR = [(["scenario", "warmup_s"], 0), (["scenario", "duration_s"], 1800.0)]
FEW_LINES = {"distribution": "normal", "mean": 1, "sd": 0.5, "min": 1, "max": 2}


def about_skus(path: Path) -> list:
    """What makes a scenario of a SKU set, an order list or a list of words."""
    file = str(path)
    if path.suffix == ".xgenc":
        changes = {"skus": {"file": file}, "orders.lines": FEW_LINES}
    elif path.suffix == ".xitem":
        stream = {"mode": "stream", "file": file}
        changes = {"skus": {"file": file}, "demand": stream, "replenishment": stream}
    else:
        changes = {"skus": {"words": file}}
    return [(["scenario", *key.split(".")], value) for key, value in changes.items()]


@pytest.fixture(scope="module")
def rows():
    """What each file handled, as rows of a table."""
    told: list[tuple[str, ...]] = []
    yield told
    head = [("file", "orders", "units", "bundles", "refused because"), ("---",) * 5]
    table = "".join(f"| {' | '.join(row)} |\n" for row in [*head, *told])
    print(f"\n{table}")
    write_text(Path("results/files-of-rawsimo.md"), table)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.relative_to(REFERENCE).as_posix())
def test_a_published_file_runs_or_is_refused(path: Path, rows):
    name = path.relative_to(REFERENCE).as_posix()
    parts = ["basic", "pp-minimal", "default"]
    overrides = list(HALF_AN_HOUR)
    if path.suffix in PLACES:
        parts[PLACES[path.suffix]] = str(path)
    else:
        parts[1] = "letters" if path.suffix == ".txt" else parts[1]
        overrides += about_skus(path)
    if name in REFUSED:
        with pytest.raises(InputError, match=REFUSED[name]) as refused:
            rmfs.simulate(*parts, seed=1, overrides=overrides)
        rows.append((name, "", "", "", str(refused.value)))
        return
    run = rmfs.simulate(*parts, seed=1, overrides=overrides, trace=True)
    handled = run.world.orders_completed, run.world.units_picked, run.world.bundles_stored
    rows.append((name, *map(str, handled), ""))
    assert run.world.orders_completed > 0
    report = check(run.layout, run.trace, until_us=round(run.end_s * 1e6))
    assert report.ok, report.summary()
