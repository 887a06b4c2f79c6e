"""Simulates and stores the runs of a calibration, and returns a column of their footprints."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.errors import InputError
from rmfs.experiments.design.planning import plan_of
from rmfs.experiments.running import run
from rmfs.experiments.store import Store
from rmfs.measure.dictionary import footprint_column, names

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from rmfs.experiments.design.planning import Plan
    from rmfs.experiments.running.driver import Watcher


@dataclass(frozen=True)
class Runs:
    """Function that simulates runs and returns one column of their footprints.

    The runs differ only in one parameter and in their seed. Runs that are already stored are not
    repeated, so an interrupted calibration can be resumed.

    Attributes
    ----------
    base
        Settings shared by all runs: `layout`, `scenario`, `controllers`, `pacing`, and parameters.
    key
        The varied parameter, such as `scenario.demand.orders_per_h`.
    column
        The footprint column.
    folder
        Folder in which the runs are stored.
    processes, watcher
        As for `rmfs.experiments.run`.

    Raises
    ------
    InputError
        If there is no such column, or it is not numerical, or it is not reproducible (such as a
        wall time).
    """

    base: Mapping[str, Any]
    key: str
    column: str
    folder: Path
    processes: int | None = None
    watcher: Watcher | None = None

    def __post_init__(self) -> None:
        found = footprint_column(self.column)
        if found is None or not found.is_number or found.measured:
            from difflib import get_close_matches

            near = get_close_matches(self.column, names("footprint"), n=3)
            hint = f"; did you mean {' or '.join(near)}?" if near else ""
            raise InputError(f"column {self.column}: not a number of the footprint{hint}")

    def plan(self, level: float, seeds: Sequence[int]) -> Plan:
        """Return the plan of the runs at one level of the varied parameter.

        Raises
        ------
        InputError
            If an argument is invalid.
        """
        table = {
            "format": "rmfs-design/1",
            "name": re.sub(r"[^A-Za-z0-9._-]", "-", f"calibrate-{self.column}"),
            "seeds": list(seeds),
            "base": dict(self.base),
            "factors": {self.key: [float(level)]},
        }
        made = plan_of(table, Path(), f"{self.key} = {level:g}")
        if made.problems:
            raise InputError(made.problems[0])
        return made

    def __call__(self, level: float, seeds: Sequence[int]) -> NDArray[np.float64]:
        """Return the value of the column for each seed, shape (N,).

        Raises
        ------
        InputError
            If an argument is invalid, or a run fails.
        """
        made = self.plan(level, seeds)
        done = run(made, self.folder, processes=self.processes, watcher=self.watcher)
        if done.failed:
            raise InputError(
                f"{self.key} = {level:g}: {len(done.failed)} of {done.wanted} runs failed: see "
                f"{self.folder / 'failures'}"
            )
        rows = Store(self.folder).rows(["arm_digest", "seed", self.column])
        rows = rows[rows["arm_digest"] == made.arms[0].digest].set_index("seed")
        return rows.loc[list(seeds), self.column].to_numpy(np.float64)
