"""What a search for a path takes on this machine: the rates of `pacing.planning = work`.

`python -m tests.tools.calibrate_planning` simulates several sites five times each with plans that
take no simulated time, so that all repetitions make the same searches, and takes the least wall
time of each search (which other programs disturb little). Seconds per search and per label are
fitted to these by least squares, neither below zero. It writes
`results/published/seconds-per-label.md` and .csv. The defaults in
`rmfs/simulation/pacing/planning.py` are those of the published table.
"""

from __future__ import annotations

import argparse
import datetime
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import nnls

from rmfs import simulate
from rmfs.files import write_text
from tests.tools.calibrate import processor

PLACE = Path("results") / "published" / "seconds-per-label"
REPETITIONS = 5

CASES: list[tuple[str, str, int | None, int]] = [
    ("default", "default", 16, 1800),
    ("default", "default", 32, 1800),
    ("study-32", "pp-minimal", None, 1800),
    ("study-128", "pp-minimal", None, 600),
    ("study-tiers", "pp-minimal", None, 600),
]
"""Layout, scenario, robots and duration (s)."""


def searches(layout: str, scenario: str, robots: int | None, duration_s: int) -> pd.DataFrame:
    """Return `labels` and least `seconds` of each search of a run."""
    given: dict[str, Any] = {"scenario.warmup_s": 0, "scenario.duration_s": duration_s}
    given |= {"pacing.planning": "fixed=0"} | ({} if robots is None else {"layout.robots": robots})
    runs = [simulate(layout, scenario, seed=1, set=given) for _ in range(REPETITIONS)]
    tables = [run.table("plans") for run in runs]
    seconds = np.min([table["wall_s"] for table in tables], axis=0)
    case = f"{layout}, {runs[0].layout.robots} robots"
    return pd.DataFrame({"case": case, "labels": tables[0]["labels"], "seconds": seconds})


def rates(measured: pd.DataFrame) -> tuple[float, float]:
    """Fit seconds per search, and per label."""
    seconds = measured["seconds"].to_numpy()
    parts = np.stack([np.ones(len(measured)), measured["labels"].to_numpy(float)], axis=1)
    # a microsecond of a short search counts as much as its like of a long one
    weight = 1.0 / np.sqrt(seconds)
    (search, label), _ = nnls(parts * weight[:, np.newaxis], seconds * weight)
    return float(search), float(label)


def main(arguments: list[str] | None = None) -> None:
    """Measure, and write the table."""
    options = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    options.add_argument("--out", type=Path, default=PLACE, help=f"default: {PLACE}")
    given = options.parse_args(arguments)
    measured = pd.concat([searches(*case) for case in CASES])
    search, label = rates(measured)
    measured["charged"] = search + label * measured["labels"]
    cases = measured.groupby("case", sort=False)
    found = pd.DataFrame(
        {
            "searches": cases.size(),
            "labels": cases["labels"].mean(),
            "seconds": cases["seconds"].mean(),
            "charged": cases["charged"].sum() / cases["seconds"].sum(),
        }
    )
    told = (
        f"{search:.3g} s per search and {label:.3g} s per label. Measured by `python -m "
        f"tests.tools.calibrate_planning` on {datetime.date.today()}: {processor()}. labels and "
        "seconds: means per search; charged: what `work` charges, as a share of what was measured."
    )
    given.out.parent.mkdir(parents=True, exist_ok=True)
    write_text(given.out.with_suffix(".csv"), found.to_csv(float_format="%.4g"))
    text = found.to_markdown(floatfmt=".3g")
    write_text(given.out.with_suffix(".md"), f"{text}\n\n{told}\n")
    print(f"{text}\n\n{told}")


if __name__ == "__main__":
    main()
