"""Compares two checkouts on RAWSim-O's public instances: `python -m tests.tools.checkouts OTHER`.

Each case is simulated with several seeds, by the other checkout and by this one in turns, in
processes of their own. The table shows how many times faster this checkout simulates (ratio of the
wall times of the simulation loop, geometric mean over the seeds), and by how many percent the
numbers of orders differ. Both have 95 % confidence intervals, paired by seed. The machine should be
idle otherwise; the other checkout must have its compiled core in place.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from rmfs.experiments.statistics import interval
from rmfs.files import write_text
from tests.tools.checkout import ENVIRONMENT, ROOT

if TYPE_CHECKING:
    from collections.abc import Sequence

INSTANCES = ROOT.parent / "shared" / "reference" / "instances"

RUN = """\
import json, sys
import rmfs

layout, scenario, controllers, duration_s, seed = sys.argv[1:6]
given = [["scenario.duration_s", float(duration_s)], ["scenario.warmup_s", 0.0]]
given += [setting.split("=") for setting in sys.argv[6:]]
overrides = [(name.split("."), value) for name, value in given]
run = rmfs.simulate(layout, scenario, controllers, seed=int(seed), overrides=overrides)
print(json.dumps([run.wall_s, int(run.footprint["orders_completed"])]))
"""
"""Program that simulates one run, and prints the wall time of its loop in s, and its orders."""


@dataclass(frozen=True)
class Case:
    """A run to be compared.

    Attributes
    ----------
    layout, scenario
        Files in the folder of the public instances.
    controllers
        A shipped set of controllers.
    hours
        Simulated time.
    settings
        Further settings, as `name=value`.
    """

    layout: str
    scenario: str
    controllers: str
    hours: float
    settings: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Name of the case in the table."""
        values = [setting.partition("=")[2] for setting in self.settings]
        return ", ".join([Path(self.layout).stem, self.controllers, *values])


PP = "pp/PPMinimal.xsett"
CASES = [
    Case("pp/1-4-4-32-550.xinst", PP, "random", 4),
    Case("pp/1-4-4-32-550.xinst", PP, "default", 4),
    Case("pp/1-12-20-128-1965.xinst", PP, "random", 1),
    Case("pp/1-12-20-128-1965.xinst", PP, "default", 1),
    Case("pp/3-12-12-96-1650.xinst", PP, "random", 1),
    Case("pp/3-12-12-96-1650.xinst", PP, "default", 1),
    Case("pp/1-4-4-32-550.xinst", PP, "random", 0.5, ("controllers.pp.name=far",)),
    Case("pp/1-4-4-32-550.xinst", PP, "random", 0.5, ("controllers.pp.name=whca-n",)),
    Case("core/jenPPinstance.xinst", "core/jenPP.xsett", "default", 8),
    Case("core/jenkinsinstance1.xinst", "core/jenPP.xsett", "default", 4),
    Case("basic/BasicInstance.xlayo", "basic/BasicInstance.xsett", "default", 8),
    Case("repositioning/RepoSmall.xlayo", "mati/MaTi-SKU1000.xsett", "default", 4),
    Case("mati/MaTiMilli.xinst", "mati/MaTi-SKU100.xsett", "default", 8),
    Case(
        "fastlane/1-4-4-32-0.85.xlayo",
        "fastlane/SimpleItem-Fill-200-200-172800.xsett",
        "default",
        48,
    ),
]


def simulate(checkout: Path, case: Case, seed: int) -> tuple[float, int]:
    """Simulate a case with a checkout; return the loop's wall time in s, and the orders."""
    files = [str(INSTANCES / case.layout), str(INSTANCES / case.scenario)]
    arguments = [*files, case.controllers, str(case.hours * 3600), str(seed), *case.settings]
    done = subprocess.run(
        [sys.executable, "-c", RUN, *arguments],
        cwd=checkout,
        env=ENVIRONMENT | {"PYTHONPATH": str(checkout), "OPENBLAS_NUM_THREADS": "1"},
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    loop_s, orders = json.loads(done.stdout.splitlines()[-1])
    return loop_s, orders


def compare(other: Path, case: Case, seeds: Sequence[int]) -> dict[str, object]:
    """Simulate a case with both checkouts and all seeds; return its row of the table."""
    checkouts = (other, ROOT)
    runs = np.array([[simulate(one, case, seed) for one in checkouts] for seed in seeds])
    seconds, orders = runs[..., 0], runs[..., 1]
    faster = interval(np.log(seconds[:, 0] / seconds[:, 1]))
    more = interval(100.0 * (orders[:, 1] / orders[:, 0] - 1.0))
    return {
        "case": case.name,
        "hours": case.hours,
        "s before": seconds[:, 0].mean(),
        "s": seconds[:, 1].mean(),
        "times faster": np.exp(faster.mean),
        "times faster, low": np.exp(faster.low),
        "times faster, high": np.exp(faster.high),
        "orders before": orders[:, 0].mean(),
        "orders": orders[:, 1].mean(),
        "orders, %": more.mean,
        "orders, %, half": more.half_width,
    }


def main() -> None:
    """Compare, print each row, and write the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("other", type=Path, help="the other checkout")
    parser.add_argument("--seeds", type=int, default=10, help="number of seeds")
    parser.add_argument("--cases", nargs="*", default=[""], help="parts of the names of cases")
    parser.add_argument("--out", type=Path, help="file for the table (CSV)")
    given = parser.parse_args()
    rows = []
    for case in CASES:
        if any(part in case.name for part in given.cases):
            rows.append(compare(given.other.resolve(), case, range(1, given.seeds + 1)))
            row = rows[-1].items()
            print(
                ", ".join(f"{k} {v:.4g}" if isinstance(v, float) else f"{k} {v}" for k, v in row),
                flush=True,
            )
    if given.out is not None:
        write_text(given.out, pd.DataFrame(rows).to_csv(index=False))


if __name__ == "__main__":
    main()
