"""What a unit of work of each solver takes on this machine: the rates of the pacing mode `work`.

`python -m tests.tools.calibrate` collects the questions that controllers ask in short runs,
answers each again three times, and takes the least processor time (which other programs disturb
little).

Per back end, seconds of a call, per unit of work and per entry built are fitted to that by least
squares, none below zero. It writes `results/published/seconds-per-unit.md` and .csv, and prints
the key `pacing.seconds_per_unit` for one's own runs. The defaults in
`rmfs/simulation/pacing/computed.py` are those of the published table.
"""

from __future__ import annotations

import argparse
import datetime
import platform
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from scipy.optimize import nnls

from rmfs import simulate
from rmfs.files import write_text
from rmfs.observer import Observer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.control.asks import Ask, Call

PLACE = Path("results") / "published" / "seconds-per-unit"
CASES_PLACE = PLACE.with_name("seconds-charged.csv")
DURATION_S = 600.0
QUESTIONS = 40
"""Most questions of a run that are answered again, evenly spread over it."""
REPETITIONS = 3
LONG = 1.0
"""Limit in deterministic seconds of the runs that let CP-SAT search."""

Overrides = list[tuple[list[str], Any]]

CASES: list[tuple[str, str, str, Overrides]] = [
    ("small", "small", "hadgs", []),
    ("small", "small", "pile-on", []),
    ("small", "small", "pile-on-split", []),
    ("small", "small", "m1g", [(["controllers", "ta", "work_s"], LONG)]),
    ("large", "large", "pile-on", [(["scenario", "duration_s"], 120.0)]),
    ("large", "large", "pile-on-split", [(["scenario", "duration_s"], 120.0)]),
    ("small", "small", "psa-placement", []),
    ("small", "small", "psa-prices", []),
    ("small", "small", "psa-stays", []),
    ("small", "small", "ta-matching", []),
    ("small", "small", "ta-balance", []),
    ("small", "small", "ta-routes", []),
    ("small", "small", "ta-routes", [(["controllers", "ta", "method"], "cp_sat")]),
    (
        "small",
        "small",
        "ta-routes",
        [(["controllers", "ta", "method"], "columns"), (["controllers", "ta", "work_s"], LONG)],
    ),
    (
        "default",
        "default",
        "ta-routes",
        [
            (["scenario", "duration_s"], 120.0),
            (["controllers", "ta", "method"], "columns"),
            (["controllers", "ta", "work_s"], LONG),
        ],
    ),
    ("large", "large", "ta-routes", [(["scenario", "duration_s"], 120.0)]),
    ("default", "default", "psa-prices", []),
    ("large", "large", "psa-placement", [(["scenario", "duration_s"], 120.0)]),
    ("large", "large", "ta-matching", [(["scenario", "duration_s"], 120.0)]),
    ("small", "small", "planning", []),
    ("small", "small", "planning", [(["controllers", "ta", "method"], "greedy")]),
    ("large", "large", "planning", [(["scenario", "duration_s"], 300.0)]),
    (
        "large",
        "large",
        "planning",
        [(["scenario", "duration_s"], 300.0), (["controllers", "ta", "method"], "greedy")],
    ),
    ("small", "small", "stocking", []),
    ("small", "small", "stocking", [(["controllers", "rps", "method"], "highs")]),
    ("small", "small", "stocking", [(["controllers", "rps", "method"], "rounding")]),
]
"""Layout, scenario, controllers, overrides."""


class Collector(Observer):
    """Keeps the questions of a run."""

    def __init__(self) -> None:
        self.asks: list[Ask[Any]] = []

    def optimiser_answered(self, call: Call) -> None:
        """Keep what was asked."""
        self.asks.append(call.ask)


def questions(layout: str, scenario: str, controllers: str, more: Overrides) -> list[Ask[Any]]:
    """Return questions that controllers ask in a short run."""
    collector = Collector()
    overrides: Overrides = [(["scenario", "duration_s"], DURATION_S), *more]
    simulate(layout, scenario, controllers, seed=1, overrides=overrides, observers=[collector])
    step = max(1, -(-len(collector.asks) // QUESTIONS))
    return collector.asks[::step]


def answered(asks: Sequence[Ask[Any]], case: str) -> pd.DataFrame:
    """Answer questions again: `backend`, `work`, `built` and `seconds` of the processor."""
    rows = []
    for ask in asks:
        seconds = []
        for _ in range(REPETITIONS):
            begin = time.process_time()
            answer = ask.solve(ask.question)
            seconds.append(time.process_time() - begin)
        rows.append((case, answer.backend, answer.work, answer.built, min(seconds)))
    return pd.DataFrame(rows, columns=["case", "backend", "work", "built", "seconds"])


def rates(measured: pd.DataFrame) -> pd.DataFrame:
    """Fit seconds per call and per unit of work, per back end.

    Parameters
    ----------
    measured
        As `answered` returns it.

    Returns
    -------
    Indexed by back end: `calls`, `seconds_per_call`, `seconds_per_unit`, `seconds_per_entry`, and
    `error`, the mean absolute difference between fitted and measured seconds / the mean of the
    measured.
    """
    rows = {}
    for backend, calls in measured.groupby("backend"):
        work, seconds = calls["work"].to_numpy(), calls["seconds"].to_numpy()
        built = calls["built"].to_numpy()
        # columns of like size: units of work differ by ten orders of magnitude
        unit, entry = max(float(work.max()), 1e-12), max(float(built.max()), 1.0)
        # questions of equal work cannot tell a call from its units: then all is in the units
        per_call = np.full_like(work, float(np.ptp(work) > 0))
        parts = np.stack([per_call, work / unit, built / entry], axis=1)
        # a millisecond of a short call counts as much as its like of a long one
        weight = 1.0 / np.sqrt(seconds)
        found, _ = nnls(parts * weight[:, np.newaxis], seconds * weight)
        fitted = parts @ found
        rows[backend] = {
            "calls": len(calls),
            "seconds_per_call": found[0],
            "seconds_per_unit": found[1] / unit,
            "seconds_per_entry": found[2] / entry,
            "error": float(np.abs(fitted - seconds).mean() / seconds.mean()),
        }
    made = pd.DataFrame.from_dict(rows, orient="index")
    made.index.name = "backend"
    return made.astype({"calls": int})


def named(case: tuple[str, str, str, Overrides]) -> str:
    """Return layout, controllers and overrides of a case in a few words."""
    layout, _, controllers, more = case
    return ", ".join([f"{layout} {controllers}", *(f"{path[-1]}={value}" for path, value in more)])


def charged(measured: pd.DataFrame, found: pd.DataFrame) -> pd.DataFrame:
    """Compare what `work` charges with what was measured, case by case.

    Parameters
    ----------
    measured
        As `answered` returns it.
    found
        As `rates` returns it.

    Returns
    -------
    Indexed by case: `calls`, the mean `seconds` of a call, and `charged`, by what `work` charges in
    all / what was measured in all.
    """
    rate = found.loc[measured["backend"]].reset_index(drop=True)
    made = measured.reset_index(drop=True)
    made["charged"] = (
        rate["seconds_per_call"]
        + rate["seconds_per_unit"] * made["work"]
        + rate["seconds_per_entry"] * made["built"]
    )
    cases = made.groupby("case", sort=False)
    total = cases["seconds"].sum()
    return pd.DataFrame(
        {
            "calls": cases.size(),
            "seconds": cases["seconds"].mean(),
            "charged": cases["charged"].sum() / total,
        }
    )


def processor() -> str:
    """Return the name of the processor as far as the system tells it."""
    told = Path("/proc/cpuinfo")
    lines = told.read_text(encoding="utf-8").splitlines() if told.is_file() else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def with_kept(path: Path, key: str, new: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of a published table that were not measured again, followed by new ones."""
    before = pd.read_csv(path, index_col=key)
    both: pd.DataFrame = pd.concat([before.drop(index=new.index, errors="ignore"), new])
    return both


def main(arguments: list[str] | None = None) -> None:
    """Measure, and write the table."""
    options = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    options.add_argument("--out", type=Path, default=PLACE, help=f"default: {PLACE}")
    options.add_argument(
        "--controllers", nargs="*", help="only these; rows of back ends they do not ask are kept"
    )
    options.add_argument("--back-ends", nargs="*", help="only these; the rows of others are kept")
    given = options.parse_args(arguments)
    cases = [case for case in CASES if given.controllers is None or case[2] in given.controllers]
    measured = pd.concat([answered(questions(*case), named(case)) for case in cases])
    if given.back_ends is not None:
        measured = measured[measured["backend"].isin(given.back_ends)]
    found = rates(measured)
    ratios = charged(measured, found)
    ratios_place = given.out.with_name(CASES_PLACE.name)
    if given.controllers is not None or given.back_ends is not None:
        found = with_kept(given.out.with_suffix(".csv"), "backend", found).sort_index()
        ratios = with_kept(ratios_place, "case", ratios)
    told = (
        f"Measured by `python -m tests.tools.calibrate` on {datetime.date.today()}: "
        f"{processor()}, Python {platform.python_version()}. "
        "seconds_per_entry: of the solver's model that is built; seconds_per_call: of all else "
        "that grows with neither."
    )
    given.out.parent.mkdir(parents=True, exist_ok=True)
    write_text(given.out.with_suffix(".csv"), found.to_csv(float_format="%.4g"))
    write_text(ratios_place, ratios.to_csv(float_format="%.4g"))
    text = found.reset_index().to_markdown(index=False, floatfmt=".3g")
    cases_text = ratios.to_markdown(floatfmt=".3g")
    write_text(given.out.with_suffix(".md"), f"{text}\n\n{told}\n\n{cases_text}\n")
    print(f"{text}\n\n{told}\n\n{cases_text}")
    values = ", ".join(f"{name} = {rate:.3g}" for name, rate in found["seconds_per_unit"].items())
    print(f"pacing.seconds_per_unit = {{ {values} }}")


if __name__ == "__main__":
    main()
