"""The commands of `rmfs experiment`: plan, run, status, table, plot and others.

If a function raises `InputError`, the command line prints its message and exits with code 2.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rmfs.errors import InputError
from rmfs.experiments.calibration.command import calibrate
from rmfs.experiments.console import open_console
from rmfs.experiments.opening import RESULTS, made_below, opened, shipped
from rmfs.experiments.options import (
    Bootstrap,
    Columns,
    Confidence,
    Design,
    FileOption,
    Interactions,
    Jobs,
    Lacking,
    Made,
    Out,
)
from rmfs.experiments.showing import (
    anovas,
    chosen_table,
    require_columns,
    tell_lacking,
    write_table,
)
from rmfs.experiments.showing import goals as goals_of

if TYPE_CHECKING:
    from rmfs.experiments.design.planning import Plan

app = typer.Typer(help="Run experiments of many arms and seeds.", no_args_is_help=True)
app.command()(calibrate)

FAILED = 1
"""Exit code if runs failed."""


@app.command("list")
def list_experiments(
    folder: Annotated[Path, typer.Argument(help="Folder of results.", show_default=True)] = RESULTS,
) -> None:
    """List the shipped designs, and the experiments whose results are in a folder."""
    from rich import box
    from rich.table import Table as RichTable

    from rmfs.experiments.running.driver import progress_of

    console = open_console()
    designs = RichTable("shipped design", "description", box=box.SIMPLE_HEAD)
    for name, description in shipped():
        designs.add_row(name, description)
    console.print(designs)
    results = RichTable("results", "design", "runs", "failed", box=box.SIMPLE_HEAD)
    for one in made_below(folder):
        done = progress_of(one.plan, one.store)
        counts = f"{done.finished} of {done.wanted}", str(len(done.failed))
        results.add_row(str(one.store.folder), one.plan.design.name, *counts)
    if results.row_count:
        console.print(results)
    else:
        typer.echo(f"{folder}: no results of experiments")


@app.command()
def plan(
    design: Design,
    out: Out = None,
    jobs: Jobs = None,
    arms: Annotated[bool, typer.Option("--arms", help="List all arms.")] = False,
    pilot: Annotated[bool, typer.Option(help="Estimate the time by short runs.")] = True,
) -> None:
    """Check a design: print its errors or, if there are none, its size and the estimated time.

    To show the size, the command prints the factors with their levels, and the numbers of arms and
    runs.
    """
    from rmfs.experiments.complete import may_grow
    from rmfs.experiments.design.stages import schedule
    from rmfs.experiments.results import assigned, failed_pairs
    from rmfs.experiments.running import cores
    from rmfs.experiments.running.pilot import estimate

    one = opened(design, out)
    made, store = one.plan, one.store
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
        typer.echo("  time     unknown: no short run succeeded")
        return
    total = spoken(found.total_s(left, processes))
    typer.echo(
        f"  time     about {total} for {left} runs, {processes} at a time ({found.run_s:.1f} "
        f"s per run, up to {found.longest_s:.1f} s; from {found.source})"
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
            help="Make the runs on a cluster instead of this machine: address of a Dask scheduler, "
            "or a cluster profile (.toml).",
        ),
    ] = None,
) -> None:
    """Make all runs of a design that are not finished yet.

    If the command is interrupted, it can be repeated. If runs fail, the command still makes all
    other runs, and the exit code is 1.
    """
    from rmfs.experiments.running import run as run_plan
    from rmfs.experiments.running.progress import watching

    if Path(design).is_dir():
        raise InputError(f"{design}: is a folder; name the design file, and --out {design}")
    one = opened(design, out)
    made, store = one.plan, one.store
    with watching(made.design.name) as watcher:
        done = run_plan(made, store.folder, processes=jobs, dask=dask, watcher=watcher)
    typer.echo(f"{done.finished} of {done.wanted} runs finished, {len(done.failed)} failed")
    typer.echo(store.folder)
    if done.failed:
        raise typer.Exit(FAILED)


@app.command()
def status(design: Made, out: Out = None) -> None:
    """Show the progress of an experiment, and its failures.

    The exit code is 1 if runs failed.
    """
    from rmfs.experiments.results import assigned, failed
    from rmfs.experiments.running.driver import progress_of

    one = opened(design, out)
    made, store = one.plan, one.store
    done = progress_of(made, store)
    typer.echo(f"{made.design.name}: {done.finished} of {done.wanted} runs finished")
    rows = store.rows(["arm_digest", "arm", "replication", "seed"])
    digests = {arm.digest for arm in made.arms}
    outdated = int((~rows["arm_digest"].isin(list(digests))).sum())
    if outdated:
        typer.echo(f"{outdated} stored runs belong to other inputs and are ignored")
    if len(rows):
        mine = assigned(made, store)
        short = mine["arm"].value_counts()
        lacking = [arm.name for arm in made.arms if short.get(arm.name, 0) < short.max()]
        if lacking and done.finished < done.wanted:
            typer.echo(f"arms with unfinished runs: {len(lacking)}")
    lost = failed(made, store)
    for row in lost.itertuples():
        typer.echo(f"failed: {row.arm}, seed {row.seed}: {row.error}")
    if len(lost):
        typer.echo(f"tracebacks: {store.folder / 'failures'}")
        raise typer.Exit(FAILED)


@app.command()
def table(
    design: Made,
    out: Out = None,
    columns: Columns = None,
    baseline: Annotated[
        str | None,
        typer.Option(help="Baseline arm, with which all other arms are compared seed by seed."),
    ] = None,
    anova: Annotated[
        bool,
        typer.Option(
            "--anova", help="Show an analysis of variance of the factors instead of means."
        ),
    ] = False,
    interactions: Interactions = True,
    confidence: Confidence = 0.95,
    bootstrap: Bootstrap = False,
    by_factor: Annotated[
        bool,
        typer.Option(
            "--by-factor", help="Show one column per factor instead of a column with names of arms."
        ),
    ] = False,
    across: Annotated[
        str | None,
        typer.Option(
            metavar="FACTOR",
            help="Show each level of this factor as a column; rows show the levels of all other "
            "factors.",
        ),
    ] = None,
    file: FileOption = None,
    rows: Annotated[
        Path | None,
        typer.Option(
            help="Write one row per run (only the reproducible columns) to this .csv file, instead "
            "of printing the table."
        ),
    ] = None,
    allow_incomplete: Lacking = False,
) -> None:
    """Show means with confidence intervals, paired differences, or an analysis of variance.

    If runs of the design are missing, a note on the table says how many, and the exit code is 3,
    or 0 with --allow-incomplete.
    """
    from rmfs.experiments import arranging, tables
    from rmfs.experiments.results import to_csv

    one = opened(design, out)
    made, (frame, note) = one.plan, one.rows()
    chosen = list(columns or tables.COLUMNS)
    require_columns(frame, chosen)
    if anova:
        shown = anovas(made, frame, chosen, confidence, interactions=interactions)
    else:
        shown = [chosen_table(made, frame, chosen, baseline, confidence, bootstrap=bootstrap)]
        if across is not None:
            shown = [arranging.across(shown[0], made, across)]
        elif by_factor:
            shown = [arranging.by_factors(shown[0], made)]
    if file is not None and len(shown) > 1:
        raise InputError("--anova: one column for one file")
    shown = [made_table.noted(note) for made_table in shown]
    if rows is not None:
        to_csv(frame, rows)
        typer.echo(f"{rows}: {len(frame)} rows written")
    if file is not None:
        write_table(shown[0], file, made, frame, chosen)
    elif rows is None:
        console = open_console()
        for shown_table in shown:
            console.print(shown_table.rich())
    tell_lacking(note, allowed=allow_incomplete)


@app.command()
def plot(
    design: Made,
    out: Out = None,
    kind: Annotated[
        str,
        typer.Option(
            help="Kind of plot: intervals (with a point for each seed of each arm), effects (of "
            "factors and of pairs of factors), interaction (of pairs of factors), pareto (of two "
            "columns) or progression (over time; the design must keep the table series)."
        ),
    ] = "intervals",
    columns: Columns = None,
    factors: Annotated[
        list[str] | None,
        typer.Option(
            "--factor", help="For interaction: a factor to show; give two or more. [default: all]"
        ),
    ] = None,
    interactions: Interactions = True,
    goals: Annotated[
        list[str] | None,
        typer.Option(
            "--goal",
            metavar="COLUMN=more|less",
            help="For pareto: whether more or less of a column is better. [default: as stated in "
            "the data dictionary]",
        ),
    ] = None,
    confidence: Confidence = 0.95,
    file: Annotated[
        Path | None,
        typer.Option(
            "--file",
            "-f",
            help="The .png, .pdf or .svg file to write. [default: a .png file in the folder of "
            "results]",
        ),
    ] = None,
    allow_incomplete: Lacking = False,
) -> None:
    """Plot the results of an experiment.

    If runs of the design are missing, a note on the plot says how many, and the exit code is 3,
    or 0 with --allow-incomplete.
    """
    from rmfs.experiments.plotting import KINDS, Wish, draw
    from rmfs.experiments.provenance import write

    if kind not in KINDS:
        raise InputError(f"--kind {kind}: no such plot; valid: {', '.join(KINDS)}")
    one = opened(design, out)
    made, (frame, note) = one.plan, one.rows()
    chosen = list(columns or KINDS[kind])
    if kind != "progression":
        require_columns(frame, chosen)
    folder = one.store.folder
    target = file if file is not None else folder / f"{kind}-{'-'.join(chosen)}.png"
    wish = Wish(confidence, interactions, tuple(factors or ()), goals_of(goals or []), note)
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
    tell_lacking(note, allowed=allow_incomplete)


@app.command()
def report(
    design: Made,
    out: Out = None,
    columns: Columns = None,
    baseline: Annotated[
        str | None,
        typer.Option(
            help="Baseline arm, with which all other arms are compared. [default: the first]",
            show_default=False,
        ),
    ] = None,
    confidence: Confidence = 0.95,
    file: Annotated[
        Path | None,
        typer.Option(
            "--file",
            "-f",
            help="The .html file to write. [default: report.html in the folder of results]",
            show_default=False,
        ),
    ] = None,
    allow_incomplete: Lacking = False,
) -> None:
    """Write a report as one HTML file: means, differences, analyses of variance, plots.

    If runs of the design are missing, a note says how many, and the exit code is 3, or 0 with
    --allow-incomplete.
    """
    from rmfs.experiments import tables
    from rmfs.experiments.report import write_report

    one = opened(design, out)
    chosen = list(columns or tables.COLUMNS)
    require_columns(one.rows()[0], chosen)
    target = file if file is not None else one.store.folder / "report.html"
    note = write_report(one, target, chosen, baseline=baseline, confidence=confidence)
    typer.echo(f"{target}: written")
    tell_lacking(note, allowed=allow_incomplete)


def _keys(made: Plan, runs: Any) -> list[str]:
    arms = {arm.name: arm for arm in made.arms}
    return [made.job(arms[run.arm], run.replication).key for run in runs]
