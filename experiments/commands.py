"""`rmfs experiment`: plan, run, status, table, plot.

The command line prints an `InputError` as one line and exits with code 2; these functions just
raise it.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rmfs.errors import InputError
from rmfs.experiments.console import open_console

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.experiments.design.planning import Plan
    from rmfs.experiments.figures.pareto import Goal
    from rmfs.experiments.store import Store
    from rmfs.experiments.tables import Table

app = typer.Typer(help="Experiments: many arms, many seeds, one table.", no_args_is_help=True)

RESULTS = Path("results")
FAILED = 1
"""Exit code where runs failed."""

INCOMPLETE = 3
"""Exit code where a table or picture shows an experiment that lacks runs."""

Design = Annotated[
    str, typer.Argument(metavar="DESIGN", help="A design file, or the name of a shipped design.")
]
Out = Annotated[
    Path | None,
    typer.Option(help="Folder of the results. [default: results/NAME]", show_default=False),
]
Jobs = Annotated[
    int | None,
    typer.Option(
        "--jobs", "-j", min=1, help="Runs at a time. [default: one per core]", show_default=False
    ),
]
Columns = Annotated[
    list[str] | None,
    typer.Option("--column", "-c", help="Column of the footprint; may be repeated."),
]
Confidence = Annotated[float, typer.Option(min=0.5, max=0.999, help="Of the intervals.")]
Interactions = Annotated[
    bool,
    typer.Option("--interactions/--no-interactions", help="Show interactions of two factors, too."),
]
Lacking = Annotated[
    bool,
    typer.Option(
        "--allow-incomplete", help="Exit with code 0 although runs are lacking; the note stays."
    ),
]
Bootstrap = Annotated[
    bool, typer.Option("--bootstrap", help="BCa bootstrap intervals instead of Student's t.")
]


@app.command()
def plan(
    design: Design,
    out: Out = None,
    jobs: Jobs = None,
    arms: Annotated[bool, typer.Option("--arms", help="List all arms.")] = False,
    pilot: Annotated[bool, typer.Option(help="Try out short runs to estimate the time.")] = True,
) -> None:
    """Check a design: number of runs, time, and everything that is wrong with it."""
    from rmfs.experiments.complete import may_grow
    from rmfs.experiments.design.stages import schedule
    from rmfs.experiments.results import assigned, failed_pairs
    from rmfs.experiments.running import cores
    from rmfs.experiments.running.pilot import estimate

    made = _planned(design)
    store = _store(made, out)
    _refuse(made)
    runs = schedule(made, assigned(made, store), failed_pairs(made, store))
    finished = store.finished(made.design.keep)
    keys = _keys(made, runs.runs)
    left = sum(key not in finished for key in keys)
    at_least = "" if runs.complete or not may_grow(made) else " at least (stages may add some)"
    typer.echo(f"{made.design.name}: {made.design.description}".rstrip(": "))
    typer.echo(f"  hash     {made.hash}")
    for factor, short in made.short_names.items():
        levels = list(dict.fromkeys(str(arm.levels[factor]) for arm in made.arms))
        typer.echo(f"  factor   {short} ({factor}): {', '.join(levels)}")
    typer.echo(f"  arms     {len(made.arms)}")
    typer.echo(f"  runs     {len(keys)}{at_least}, {len(keys) - left} finished")
    if arms:
        for arm in made.arms:
            typer.echo(f"    {arm.name}")
    if pilot and left:
        processes = jobs or cores()
        found = estimate(made, store)
        _tell_time(found, left, processes)


def _tell_time(found: Any, left: int, processes: int) -> None:
    from rmfs.experiments.running.progress import spoken

    if found is None:
        typer.echo("  time     unknown: no short run got through")
        return
    total = spoken(found.total_s(left, processes))
    typer.echo(
        f"  time     about {total} for {left} runs, {processes} at a time "
        f"({found.run_s:.1f} s a run, up to {found.longest_s:.1f} s; from {found.source})"
    )


@app.command()
def run(
    design: Design,
    out: Out = None,
    jobs: Jobs = None,
    dask: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS",
            help="Scheduler of a Dask cluster, or a cluster profile (.toml), instead of this "
            "machine.",
        ),
    ] = None,
) -> None:
    """Do all runs of a design that are not finished yet; may be interrupted and called again.

    Exit code 1 if runs failed: the others are done all the same.
    """
    from rmfs.experiments.running import run as run_plan
    from rmfs.experiments.running.progress import watching

    made = _planned(design)
    _refuse(made)
    store = _store(made, out)
    with watching(made.design.name) as watcher:
        done = run_plan(made, store.folder, processes=jobs, dask=dask, watcher=watcher)
    typer.echo(f"{done.finished} of {done.wanted} runs finished, {len(done.failed)} failed")
    typer.echo(store.folder)
    if done.failed:
        raise typer.Exit(FAILED)


@app.command()
def status(design: Design, out: Out = None) -> None:
    """Say how far an experiment has come, and what failed."""
    from rmfs.experiments.results import assigned, failed
    from rmfs.experiments.running.driver import progress_of

    made = _planned(design)
    _refuse(made)
    store = _store(made, out)
    done = progress_of(made, store)
    typer.echo(f"{made.design.name}: {done.finished} of {done.wanted} runs finished")
    rows = store.rows(["arm_digest", "arm", "replication", "seed"])
    digests = {arm.digest for arm in made.arms}
    outdated = int((~rows["arm_digest"].isin(list(digests))).sum())
    if outdated:
        typer.echo(f"{outdated} stored runs belong to other inputs and do not count")
    if len(rows):
        mine = assigned(made, store)
        short = mine["arm"].value_counts()
        lacking = [arm.name for arm in made.arms if short.get(arm.name, 0) < short.max()]
        if lacking and done.finished < done.wanted:
            typer.echo(f"arms with runs to do: {len(lacking)}")
    lost = failed(made, store)
    for row in lost.itertuples():
        typer.echo(f"failed: {row.arm}, seed {row.seed}: {row.error}")
    if len(lost):
        typer.echo(f"tracebacks: {store.folder / 'failures'}")
        raise typer.Exit(FAILED)


@app.command()
def table(
    design: Design,
    out: Out = None,
    columns: Columns = None,
    baseline: Annotated[
        str | None, typer.Option(help="Arm that all others are compared with, seed by seed.")
    ] = None,
    anova: Annotated[
        bool, typer.Option("--anova", help="Analysis of variance of the factors instead.")
    ] = False,
    interactions: Interactions = True,
    confidence: Confidence = 0.95,
    bootstrap: Bootstrap = False,
    file: Annotated[
        Path | None,
        typer.Option("--file", "-f", help="Write a .tex, .md, .csv or .html file."),
    ] = None,
    rows: Annotated[
        Path | None,
        typer.Option(help="Write the rows themselves (reproducible columns) to a .csv file."),
    ] = None,
    allow_incomplete: Lacking = False,
) -> None:
    """Show means with confidence intervals, paired differences, or an analysis of variance.

    Exit code 3 if runs of the design are lacking: a note on the table says how many.
    """
    from rmfs.experiments import tables
    from rmfs.experiments.results import to_csv

    made, frame, note = _results(design, out)
    chosen = list(columns or tables.COLUMNS)
    _require_columns(frame, chosen)
    if anova:
        shown = _anovas(made, frame, chosen, interactions=interactions)
    else:
        shown = [_table(made, frame, chosen, baseline, confidence, bootstrap=bootstrap)]
    if file is not None and len(shown) > 1:
        raise InputError("--anova: one column for one file")
    shown = [one.noted(note) for one in shown]
    if rows is not None:
        to_csv(frame, rows)
        typer.echo(f"{rows}: {len(frame)} rows written")
    if file is not None:
        _write_table(shown[0], file, made, frame, chosen)
    elif rows is None:
        console = open_console()
        for one in shown:
            console.print(one.rich())
    _tell_lacking(note, allowed=allow_incomplete)


def _write_table(
    shown: Table, file: Path, made: Plan, frame: pd.DataFrame, columns: list[str]
) -> None:
    from rmfs.experiments.provenance import write

    shown.write(file)
    beside = write(
        file,
        frame,
        design=made.design.name,
        design_hash=made.hash,
        columns=columns,
        caption=shown.caption,
    )
    typer.echo(f"{file}: written, with {beside.name}")


def _anovas(
    made: Plan, frame: pd.DataFrame, columns: list[str], *, interactions: bool
) -> list[Table]:
    from rmfs.experiments import tables
    from rmfs.experiments.statistics import anova

    named, factors = made.short_names, made.factors
    return [
        tables.effects(
            anova(frame, column, factors, interactions=interactions, names=named), column
        )
        for column in columns
    ]


def _table(
    made: Plan,
    frame: pd.DataFrame,
    columns: list[str],
    baseline: str | None,
    confidence: float,
    *,
    bootstrap: bool,
) -> Table:
    from rmfs.experiments import tables

    method: Any = "bootstrap" if bootstrap else "t"
    if baseline is not None:
        made.arm(baseline)
        return tables.differences(frame, columns, baseline, confidence=confidence, method=method)
    return tables.means(frame, columns, confidence=confidence, method=method)


@app.command()
def plot(
    design: Design,
    out: Out = None,
    kind: Annotated[
        str,
        typer.Option(
            help="intervals (each seed of each arm), effects (of factors, and of pairs of them), "
            "interaction (of pairs of factors), pareto (two columns), progression (over time; the "
            "design must keep series)."
        ),
    ] = "intervals",
    columns: Columns = None,
    factors: Annotated[
        list[str] | None,
        typer.Option("--factor", help="interaction: a factor, at least two. [default: all]"),
    ] = None,
    interactions: Interactions = True,
    goals: Annotated[
        list[str] | None,
        typer.Option(
            "--goal",
            metavar="COLUMN=more|less",
            help="pareto: what is better of a column. [default: as the data dictionary says]",
        ),
    ] = None,
    confidence: Confidence = 0.95,
    file: Annotated[
        Path | None,
        typer.Option("--file", "-f", help="A .png, .pdf or .svg file. [default: in the folder]"),
    ] = None,
    allow_incomplete: Lacking = False,
) -> None:
    """Draw a picture of the results.

    Exit code 3 if runs of the design are lacking: a note on the picture says how many.
    """
    from rmfs.experiments.plotting import KINDS, Wish, draw
    from rmfs.experiments.provenance import write

    if kind not in KINDS:
        raise InputError(f"--kind {kind}: no such picture; valid: {', '.join(KINDS)}")
    made, frame, note = _results(design, out)
    chosen = list(columns or KINDS[kind])
    if kind != "progression":
        _require_columns(frame, chosen)
    folder = _store(made, out).folder
    target = file if file is not None else folder / f"{kind}-{'-'.join(chosen)}.png"
    wish = Wish(confidence, interactions, tuple(factors or ()), _goals(goals or []), note)
    draw(kind, made, frame, folder, chosen, target, wish)
    beside = write(
        target,
        frame,
        design=made.design.name,
        design_hash=made.hash,
        columns=chosen,
        kind=kind,
        confidence=confidence,
        **({"note": note} if note else {}),
    )
    typer.echo(f"{target}: written, with {beside.name}")
    _tell_lacking(note, allowed=allow_incomplete)


def _goals(given: list[str]) -> dict[str, Goal]:
    """Read the goals of columns."""
    found: dict[str, Goal] = {}
    for text in given:
        column, _, goal = text.partition("=")
        if goal not in ("more", "less"):
            raise InputError(f"--goal {text}: expected COLUMN=more or COLUMN=less")
        found[column] = "more" if goal == "more" else "less"
    return found


def _tell_lacking(note: str, *, allowed: bool) -> None:
    """Say on the terminal what an experiment lacks, and end with code 3 unless that is allowed."""
    if note:
        typer.echo(f"rmfs: {note}", err=True)
        if not allowed:
            raise typer.Exit(INCOMPLETE)


def _planned(design: str) -> Plan:
    from rmfs.experiments.design.planning import plan as make

    return make(design)


def _refuse(made: Plan) -> None:
    """Print everything that is wrong with a plan, a line each, and end with code 2."""
    if made.problems:
        for problem in made.problems:
            typer.echo(f"rmfs: {made.source}: {' '.join(problem.split())}", err=True)
        raise typer.Exit(2)


def _store(made: Plan, out: Path | None) -> Store:
    from rmfs.experiments.store import Store

    return Store(out if out is not None else RESULTS / made.design.name)


def _results(design: str, out: Path | None) -> tuple[Plan, pd.DataFrame, str]:
    """Return the plan and the finished rows of an experiment, and what it lacks."""
    from rmfs.experiments.complete import lacking
    from rmfs.experiments.results import assigned

    made = _planned(design)
    _refuse(made)
    store = _store(made, out)
    frame = assigned(made, store)
    if frame.empty:
        raise InputError(f"{store.folder}: no finished runs yet; rmfs experiment run {design}")
    return made, frame, lacking(made, store)


def _keys(made: Plan, runs: Any) -> list[str]:
    arms = {arm.name: arm for arm in made.arms}
    return [made.job(arms[run.arm], run.replication).key for run in runs]


def _require_columns(frame: pd.DataFrame, columns: list[str]) -> None:
    from rmfs.experiments.statistics.intervals import require

    require(frame, *columns)
    words = [c for c in columns if not _is_number(frame[c])]
    if words:
        raise InputError(f"column {', '.join(words)}: holds no numbers")


def _is_number(values: pd.Series) -> bool:
    from pandas.api.types import is_numeric_dtype

    return bool(is_numeric_dtype(values))
