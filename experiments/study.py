"""The function `experiment`: a whole study in one call, from factors to tables."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs.errors import InputError
from rmfs.experiments.complete import lacking
from rmfs.experiments.design.planning import plan_of
from rmfs.experiments.results import load
from rmfs.experiments.store import Store
from rmfs.experiments.tables import differences, means
from rmfs.references import plain, reference_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    import pandas as pd
    from matplotlib.figure import Figure

    from rmfs.experiments.design.planning import Plan
    from rmfs.experiments.figures.pareto import Goal
    from rmfs.experiments.running.driver import Watcher
    from rmfs.experiments.tables import Table
    from rmfs.measure.base import Measure

COLUMN = "units_per_h"
NO_LEVEL = "none"
"""Name of the level None of a factor in tables and plots."""


@dataclass(frozen=True, repr=False)
class Study:
    """An experiment and its results.

    Attributes
    ----------
    plan
        Arms, seeds and inputs.
    folder
        Folder of the results.
    """

    plan: Plan
    folder: Path

    @cached_property
    def frame(self) -> pd.DataFrame:
        """One row per run: `arm`, the factors, `replication`, the footprint."""
        return load(self.folder)

    @property
    def lacking(self) -> str:
        """Note on missing runs, shown below every table; empty if no run is missing."""
        return lacking(self.plan, Store(self.folder))

    def table(self, *columns: str, by: str | None = None, confidence: float = 0.95) -> Table:
        """Return means over the seeds with confidence intervals.

        Parameters
        ----------
        columns
            Columns of the footprint. Default `units_per_h`.
        by
            A factor. Each of its levels gets one row, for which the runs of each seed are averaged
            over all other factors; the level None is shown as "none". Default: one row per arm.

        Raises
        ------
        InputError
            If there is no such column or factor.
        """
        chosen = self._columns(columns)
        made = means(self._rows(by, chosen), chosen, confidence=confidence, by=by or "arm")
        return made.noted(self.lacking)

    def compare(
        self,
        *columns: str,
        baseline: Any = None,
        by: str | None = None,
        confidence: float = 0.95,
    ) -> Table:
        """Return paired differences (arm or level minus baseline) with confidence intervals.

        Parameters
        ----------
        columns
            Columns of the footprint. Default `units_per_h`.
        baseline
            An arm, or a level of the factor `by`. Default: the first.
        by
            As for `table`.

        Raises
        ------
        InputError
            If there is no such column, factor or baseline.
        """
        chosen = self._columns(columns)
        rows = self._rows(by, chosen)
        known = list(rows[by or "arm"].unique())
        first = known[0] if baseline is None else baseline
        if first not in known:
            raise InputError(f"baseline {first}: valid: {', '.join(map(str, known))}")
        made = differences(rows, chosen, first, confidence=confidence, by=by or "arm")
        return made.noted(self.lacking)

    def plot(
        self,
        *columns: str,
        kind: str = "intervals",
        by: str | None = None,
        factors: Sequence[str] = (),
        goals: Mapping[str, Goal] | None = None,
        confidence: float = 0.95,
    ) -> Figure:
        """Plot the results.

        Parameters
        ----------
        columns
            Columns of the footprint; for `progression`, of the table `series`. Default: depends on
            `kind`.
        kind
            `intervals`: a dot for every seed, and mean and interval of each arm. `effects`: mean at
            each level of each factor, and at each pair of levels of two factors if the runs can
            separate interactions. `interaction`: mean at each pair of levels of two factors.
            `pareto`: one column against another. `progression`: columns over time; needs
            `keep=["series"]` in `experiment`.
        by
            For `intervals`: as for `table`.
        factors
            For `interaction`: two or more factors. Default: all with more than one level.
        goals
            For `pareto`, by column: "more" if larger values are better, otherwise "less". Default:
            from the data dictionary.

        Raises
        ------
        InputError
            If there is no such plot, column or factor, or the plot cannot show these results.
        """
        from rmfs.experiments.plotting import KINDS, Wish, draw

        if kind not in KINDS:
            raise InputError(f"kind {kind}: no such plot; valid: {', '.join(KINDS)}")
        chosen = list(columns or KINDS[kind])
        rows = self.frame if kind == "progression" else self._rows(by, self._columns(chosen))
        if by is not None:
            if kind != "intervals":
                raise InputError(f"by {by}: for intervals; {kind} shows factors by itself")
            rows = rows.rename(columns={by: "arm"})
        wish = Wish(confidence, factors=tuple(factors), goals=goals or {})
        return draw(kind, self.plan, rows, self.folder, chosen, None, wish)

    def __repr__(self) -> str:
        return (
            f"Study of {len(self.plan.arms)} arms, {len(self.frame)} runs, in {self.folder}\n"
            + "\n".join(f"  {arm.name}" for arm in self.plan.arms[:16])
            + ("\n  ..." if len(self.plan.arms) > 16 else "")
        )

    def _repr_html_(self) -> str:
        return self.table()._repr_html_()

    def _columns(self, given: Sequence[str]) -> list[str]:
        wrong = [column for column in given if column not in self.frame]
        if wrong:
            raise InputError(f"{', '.join(wrong)}: no such column of the footprint")
        return list(given) or [COLUMN]

    def _rows(self, by: str | None, columns: list[str]) -> pd.DataFrame:
        """Return one row per run, or per seed and level of a factor."""
        if by is None:
            return self.frame
        if by not in self.plan.factors:
            raise InputError(f"{by}: no such factor; factors: {', '.join(self.plan.factors)}")
        if columns == [by]:
            raise InputError(f"{by}: is the factor given as `by`")
        levels = self.frame[by].astype(object)
        frame = self.frame.assign(**{by: levels.where(levels.notna(), NO_LEVEL)})
        grouped = frame.groupby([by, "replication"], sort=False)
        return grouped[columns].mean().reset_index()


def experiment(
    factors: Mapping[str, Sequence[Any]],
    *,
    seeds: Iterable[int] = range(10),
    base: Mapping[str, Any] | None = None,
    measures: Sequence[str | type[Measure]] = (),
    keep: Sequence[str] = (),
    name: str = "experiment",
    out: str | Path | None = None,
    processes: int | None = None,
    watcher: Watcher | None = None,
) -> Study:
    """Run an experiment: every combination of the factors' levels with every seed.

    Existing runs are not repeated. A design file offers more options (see `rmfs.experiments`).

    Parameters
    ----------
    factors
        A list of levels for each parameter: `{"layout.robots": [8, 16]}`. Parameters are named as
        in `set` of `rmfs.simulate`. A level may also be the class of a rule.
    seeds
        Seeds, the same for every arm, so that arms can be compared seed by seed.
    base
        Inputs of all arms: `layout`, `scenario` and `controllers` (each is `default` if not given),
        and values of further parameters, named as in `factors`.
    measures
        Additional measures, as for `rmfs.simulate`.
    keep
        Tables to keep of every run besides its footprint.
    name
        Name of the experiment.
    out
        Folder for the results. Default: a folder below `results`, named after `name` and a hash of
        the plan.
    processes
        Number of parallel runs. Default: one per core.
    watcher
        Notified of progress.

    Raises
    ------
    InputError
        If an argument is invalid; the message names it and the valid values.
    RuntimeError
        If a run failed.
    """
    from rmfs.experiments import running

    table = {
        "format": "rmfs-design/1",
        "name": re.sub(r"[^A-Za-z0-9._-]", "-", name),
        "seeds": [int(seed) for seed in seeds],
        "base": {"layout": "default", "scenario": "default", "controllers": "default"}
        | {key: plain(value, reference_of) for key, value in (base or {}).items()},
        "factors": {key: [*map(_level, levels)] for key, levels in factors.items()},
        "measures": [plain(one, reference_of) for one in measures],
        "keep": list(keep),
    }
    plan = plan_of(table, Path(), "rmfs.experiment")
    plan.require_sound()
    folder = Path(out or Path("results") / f"{table['name']}-{plan.hash[:8]}")
    done = running.run(plan, folder, processes=processes, watcher=watcher)
    if done.failed:
        from rmfs.experiments.results import failures

        first = failures(folder).iloc[0]
        raise RuntimeError(
            f"{len(done.failed)} of {done.wanted} runs failed; the first, {first['arm']} with seed "
            f"{first['seed']}: {first['error']}"
        )
    return Study(plan, folder)


def _level(value: Any) -> Any:
    """Return a level as a design contains it; a class is shown by its name."""
    if isinstance(value, type):
        return {"label": value.__name__, "value": reference_of(value)}
    return plain(value, reference_of)
