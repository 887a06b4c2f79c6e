"""Commands for finished runs: plot, report, view and compare."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rmfs.errors import InputError


def plot(
    run: Annotated[Path, typer.Argument(help="Run folder.")],
    what: Annotated[
        list[str] | None,
        typer.Option(
            help="Plot to draw: progression, heat (or heat:COLUMN, with a column of the table "
            "heat), backlog, turnover, stations, robots, pile-on or warmup; may be repeated. "
            "[default: all]",
            show_default=False,
        ),
    ] = None,
    format_: Annotated[str, typer.Option("--format", help="File format: png, svg or pdf.")] = "png",
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for the plots. [default: the run folder]", show_default=False),
    ] = None,
) -> None:
    """Plot the results of a run."""
    from rmfs.measure import load_run
    from rmfs.measure.pictures import PICTURES, save

    folder = load_run(run)
    for name in what or PICTURES:
        path = (out or run) / f"{name.replace(':', '-')}.{format_}"
        save(folder, name, path)
        print(path)


def report(
    run: Annotated[Path, typer.Argument(help="Run folder.")],
    out: Annotated[
        Path | None,
        typer.Option(
            help="HTML file to write. [default: report.html in the run folder]", show_default=False
        ),
    ] = None,
    csv: Annotated[
        bool, typer.Option("--csv", help="Also write every table as CSV into the run folder.")
    ] = False,
) -> None:
    """Write a report of a run as one HTML file."""
    from rmfs.measure import load_run
    from rmfs.measure.folder import write_csv
    from rmfs.measure.report import write_report

    folder = load_run(run)
    path = out or run / "report.html"
    write_report(folder, path)
    for file in [path, *(write_csv(folder) if csv else [])]:
        print(file)


def view(
    runs: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="[RUN [RUN]]",
            help="Run folder with a trace, or two such folders to show side by side. Without a "
            "run folder, the page shows a form with which a run can be started.",
            show_default=False,
        ),
    ] = None,
    export: Annotated[
        Path | None,
        typer.Option(
            help="Write a self-contained HTML file instead of serving a page.", show_default=False
        ),
    ] = None,
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="Port of the page; 0: any free port.")
    ] = 0,
    open_: Annotated[bool, typer.Option("--open/--no-open", help="Open a browser.")] = True,
) -> None:
    """Replay the trace of a run, or of two runs, in the browser."""
    from rmfs.view.commands import export_runs, serve_runs

    if export is None:
        serve_runs(runs or [], port=port, open_browser=open_)
    elif not runs:
        raise InputError("--export: name the run to export")
    else:
        export_runs(runs, export)
        print(export)


def compare(
    sources: Annotated[
        list[str],
        typer.Argument(
            metavar="A B ...",
            help="Run folders, experiment folders, arms of experiments (FOLDER#ARM), or tables.",
        ),
    ],
    columns: Annotated[
        list[str] | None,
        typer.Option(
            "--column",
            "-c",
            help="Column of the footprint; may be repeated. [default: the main columns]",
            show_default=False,
        ),
    ] = None,
    everything: Annotated[
        bool, typer.Option("--all", help="Show every column that differs.")
    ] = False,
    confidence: Annotated[
        float, typer.Option(min=0.5, max=0.999, help="Confidence level of the intervals.")
    ] = 0.95,
    allow_incomplete: Annotated[
        bool,
        typer.Option(
            "--allow-incomplete",
            help="Exit with code 0 even if runs are missing; the note is still printed.",
        ),
    ] = False,
) -> None:
    """Show how runs, arms or tables differ in inputs and, paired by seed, in outputs.

    If runs of an experiment are missing, a note says how many, and the exit code is 3 unless
    `--allow-incomplete` is given.
    """
    from rmfs.experiments.compare import compare as compared
    from rmfs.experiments.compare_print import print_comparisons
    from rmfs.experiments.showing import INCOMPLETE

    found = compared(sources, confidence=confidence)
    print_comparisons(found, columns or [], everything=everything)
    if any(one.notes for one in found) and not allow_incomplete:
        raise typer.Exit(INCOMPLETE)
