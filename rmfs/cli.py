"""The command line: the one place that may import everything.

Whatever a user does wrong ends in one line on the standard error stream and exit code 2; an
interruption ends in exit code 130. Imports are made inside the commands, so that help and errors
come at once.
"""

from __future__ import annotations

import importlib
import sys
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rmfs.measure.checker import CheckReport
    from rmfs.simulation.run import Run

SUB_COMMANDS = {
    "layout": ("rmfs.layout.commands", "Make, draw, check and import layouts."),
    "scenario": ("rmfs.scenario.commands", "List, show and check scenarios."),
    "controllers": ("rmfs.control.commands", "List, show and check sets of controllers."),
    "traffic": ("experiments.traffic.commands", "Path planners alone: trips, duels, growth."),
    "experiment": ("experiments.commands", "Plan and run experiments; tables and figures."),
}
"""Module and help of each group of commands; its module is imported when it is called."""

COMMANDS = {
    "demonstrate": ("rmfs.demonstrator.commands", "Run a warehouse with real robots."),
    "emulate": ("rmfs.demonstrator.commands", "Emulate a room with robots like real ones."),
}
"""The same of commands that are no groups."""

ELSEWHERE = {**SUB_COMMANDS, **COMMANDS}

UNSAFE = 1
"""Exit code where the checker finds a trace unsafe, or a bound is exceeded: a defect."""

GIVEN_UP = 1
"""Exit code where a run stops before its end: nothing can move any more (possible in layouts that
are not well-formed), an optimiser fails in a run that must repeat, or a replay differs."""

WRONG_INPUT = 2
INTERRUPTED = 130


class LazyGroup(TyperGroup):
    """A group that knows its sub-commands by name and loads one when it is called."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Name all commands, loaded or not."""
        return [*super().list_commands(ctx), *(n for n in ELSEWHERE if n not in self.commands)]

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return a command, or what help needs to know of it if it is not loaded."""
        if cmd_name in ELSEWHERE and cmd_name not in self.commands:
            return TyperGroup(name=cmd_name, help=ELSEWHERE[cmd_name][1])
        return super().get_command(ctx, cmd_name)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Load the command that is called."""
        if args and args[0] in ELSEWHERE:
            self.add_command(_loaded(args[0]), args[0])
        return super().resolve_command(ctx, args)


def _loaded(name: str) -> Any:
    """Import a command or group; it is put below another so that it gets no options of its own."""
    module = importlib.import_module(ELSEWHERE[name][0])
    above = typer.Typer(add_completion=False)
    above.add_typer(module.app, name=name if name in SUB_COMMANDS else None)
    return typer.main.get_group(above).commands[name]


app = typer.Typer(
    cls=LazyGroup,
    add_completion=False,
    pretty_exceptions_enable=False,
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def main(arguments: list[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments
        Without the program's name. Default: those of the process.

    Returns
    -------
    int
        The exit code.
    """
    command = typer.main.get_command(app)
    try:
        code = command.main(args=arguments, prog_name="rmfs", standalone_mode=False)
    except InputError as error:
        return _complain(str(error))
    except typer.TyperException as error:
        # without a message, a group was called without a command and has shown its help
        return _complain(error.format_message()) if error.format_message() else 0
    except (KeyboardInterrupt, typer.Abort):
        _complain("interrupted")
        return INTERRUPTED
    if code == INTERRUPTED:
        _complain("interrupted")
    return code if isinstance(code, int) else 0


def _complain(message: str) -> int:
    """Tell the user in one line what is wrong."""
    print(f"rmfs: {' '.join(message.split())}", file=sys.stderr)
    return WRONG_INPUT


@app.callback()
def rmfs(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Show the version and exit.")] = False,
) -> None:
    """Simulate and optimise Robotic Mobile Fulfillment Systems."""
    if version:
        from rmfs.measure.provenance import version as installed

        print(f"rmfs {installed()}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        print(context.get_help())


@app.command()
def run(
    layout: Annotated[str, typer.Option(help="Name of a shipped layout, or a file.")] = "default",
    scenario: Annotated[
        str, typer.Option(help="Name of a shipped scenario, or a file.")
    ] = "default",
    controllers: Annotated[
        str, typer.Option(help="Name of a shipped set of controllers, or a file.")
    ] = "default",
    seed: Annotated[int, typer.Option(min=0, help="Seed of all random streams.")] = 0,
    out: Annotated[
        Path | None, typer.Option(help="Run folder. [default: below results/]", show_default=False)
    ] = None,
    set_: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help="Override a parameter, for example layout.robots=16; may be repeated.",
        ),
    ] = None,
    pacing: Annotated[
        str,
        typer.Option(
            metavar="MODE",
            help="What the thinking of optimisers costs in simulated time: instant, wall, work, "
            "fixed=SECONDS or replay=RUN_DIR; parameters by --set pacing.KEY=VALUE.",
        ),
    ] = "instant",
    trace: Annotated[bool, typer.Option("--trace", help="Write the trace of all motion.")] = False,
    record: Annotated[
        Path | None,
        typer.Option(
            help="Folder for the orders and bundles that come, to be replayed (orders.csv, "
            "bundles.csv).",
            show_default=False,
        ),
    ] = None,
    check: Annotated[
        bool, typer.Option("--check", help="Prove the motion safe; fills `collisions`.")
    ] = False,
    allow_not_well_formed: Annotated[
        bool,
        typer.Option(
            "--allow-not-well-formed", help="Run a layout in which robots may block each other."
        ),
    ] = False,
    live: Annotated[
        bool, typer.Option("--live", help="Show the run in the browser while it happens.")
    ] = False,
    speed: Annotated[
        float | None,
        typer.Option(
            help="With --live: simulated seconds per second to begin with. "
            "[default: as fast as it goes]",
            show_default=False,
        ),
    ] = None,
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="With --live: of the page; 0: any free.")
    ] = 0,
    open_: Annotated[
        bool, typer.Option("--open/--no-open", help="With --live: open a browser.")
    ] = True,
    await_page: Annotated[bool, typer.Option("--await-page", hidden=True)] = False,
) -> None:
    """Simulate a warehouse and write a run folder."""
    from rmfs.config import parse_override
    from rmfs.measure.folder import fill, reserved
    from rmfs.scenario import StreamRecorder, write_streams

    overrides = [parse_override(text) for text in set_ or []]
    inputs = {"layout": layout, "scenario": scenario, "controllers": controllers}
    target = out or Path("results") / default_name(inputs, seed)
    streams = None if record is None else StreamRecorder()
    if speed is not None and not live:
        raise InputError("--speed: only with --live")
    with ExitStack() as stack:
        watching: dict[str, Any] = {}
        if live:
            from rmfs.view.commands import watched

            watcher = stack.enter_context(
                watched(
                    inputs,
                    target.name,
                    port=port,
                    speed=speed,
                    open_browser=open_,
                    await_page=await_page,
                )
            )
            watching = {"events": watcher.events, "observers": [watcher]}
        folder = stack.enter_context(reserved(target))
        done = simulated(
            inputs,
            seed=seed,
            overrides=overrides,
            pacing=pacing,
            trace=trace or check,
            streams=streams,
            allow_not_well_formed=allow_not_well_formed,
            **watching,
        )
        if record is not None and streams is not None:
            step("writing the streams")
            write_streams(streams, done.world.skus, record)
        report = proven(done) if check else None
        step("writing the tables")
        fill(folder, done, report=report, trace=trace, inputs=inputs)
    conclude(target, report)


@app.command()
def bench(
    runs: Annotated[int, typer.Option(min=1, help="Runs of each case; the median counts.")] = 5,
    out: Annotated[Path, typer.Option(help="Folder of the tables.")] = Path("results/bench"),
) -> None:
    """Measure how fast runs are and where their time goes."""
    from experiments import speed

    frame = speed.table(runs=runs, tell=step)
    speed.save(frame, out)
    typer.echo(speed.to_markdown(frame))


@app.command()
def plot(
    run: Annotated[Path, typer.Argument(help="Run folder.")],
    what: Annotated[
        list[str] | None,
        typer.Option(
            help="Picture: progression, heat (or heat:COLUMN of its table), backlog, turnover, "
            "stations, robots, pile-on, warmup; may be repeated. [default: all]",
            show_default=False,
        ),
    ] = None,
    format_: Annotated[str, typer.Option("--format", help="png, svg or pdf.")] = "png",
    out: Annotated[
        Path | None, typer.Option(help="Folder. [default: the run folder]", show_default=False)
    ] = None,
) -> None:
    """Draw pictures of a run."""
    from rmfs.measure import load_run
    from rmfs.measure.pictures import PICTURES, save

    folder = load_run(run)
    for name in what or PICTURES:
        path = (out or run) / f"{name.replace(':', '-')}.{format_}"
        save(folder, name, path)
        print(path)


@app.command()
def report(
    run: Annotated[Path, typer.Argument(help="Run folder.")],
    out: Annotated[
        Path | None,
        typer.Option(
            help="HTML file. [default: report.html in the run folder]", show_default=False
        ),
    ] = None,
    csv: Annotated[
        bool, typer.Option("--csv", help="Write every table as CSV, too, into the run folder.")
    ] = False,
) -> None:
    """Write a report of a run: one HTML file."""
    from rmfs.measure import load_run
    from rmfs.measure.folder import write_csv
    from rmfs.measure.report import write_report

    folder = load_run(run)
    path = out or run / "report.html"
    write_report(folder, path)
    for file in [path, *(write_csv(folder) if csv else [])]:
        print(file)


@app.command()
def view(
    runs: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="[RUN [RUN]]",
            help="Run folder with a trace; two side by side; none: a form that starts a run.",
            show_default=False,
        ),
    ] = None,
    export: Annotated[
        Path | None,
        typer.Option(help="Write one HTML file to send instead.", show_default=False),
    ] = None,
    port: Annotated[int, typer.Option(min=0, max=65535, help="Of the page; 0: any free.")] = 0,
    open_: Annotated[bool, typer.Option("--open/--no-open", help="Open a browser.")] = True,
) -> None:
    """Look at a run in the browser: a replay of its trace."""
    from rmfs.view.commands import export_runs, serve_runs

    if export is None:
        serve_runs(runs or [], port=port, open_browser=open_)
    elif not runs:
        raise InputError("--export: name the run to be written")
    else:
        export_runs(runs, export)
        print(export)


@app.command("import")
def import_command(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="DIR", help="A folder with files of RAWSim-O, or one such file.", exists=False
        ),
    ],
    out: Annotated[
        Path | None,
        typer.Option(help="Folder to make. [default: below results/imported/]", show_default=False),
    ] = None,
) -> None:
    """Turn RAWSim-O's files into ours; list what differs, is dead, unknown or refused."""
    from rmfs.importing import LIST, Imported, import_files

    def told(one: Imported) -> None:
        print(*one.lines(), sep="\n", flush=True)

    target = out or Path("results") / "imported" / source.resolve().stem
    done = import_files(source, target, told)
    print(target / LIST)
    if any(one.refused for one in done):
        raise typer.Exit(WRONG_INPUT)


@app.command(hidden=True)
def docs(
    folder: Annotated[Path, typer.Argument(help="Folder of the pages.")] = Path("docs"),
) -> None:
    """Write the pages of the documentation that are generated."""
    from rmfs.measure.pages import write_pages

    write_pages(folder)


@app.command()
def compare(
    sources: Annotated[
        list[str],
        typer.Argument(
            metavar="A B ...",
            help="Run folders, folders of experiments, their arms (FOLDER#ARM), or tables.",
        ),
    ],
    columns: Annotated[
        list[str] | None,
        typer.Option("--column", "-c", help="Column of the footprint; may be repeated."),
    ] = None,
    everything: Annotated[
        bool, typer.Option("--all", help="Show every column that differs.")
    ] = False,
    confidence: Annotated[float, typer.Option(min=0.5, max=0.999, help="Of the intervals.")] = 0.95,
) -> None:
    """Say in what runs, arms or tables differ: input and output, paired by seed."""
    from experiments.commands import print_comparisons
    from experiments.compare import compare as compared

    print_comparisons(
        compared(sources, confidence=confidence), columns or [], everything=everything
    )


def simulated(inputs: dict[str, str], *, seed: int, **options: Any) -> Run:
    """Simulate and show progress; a run in which nothing can move any more ends with a report.

    Parameters
    ----------
    inputs
        Layout, scenario and controllers as the user named them.
    options
        Further parameters of `rmfs.simulate`.
    """
    from rmfs.simulation.pacing import OptimiserError, ReplayError
    from rmfs.simulation.run import simulate
    from rmfs.simulation.simulation import StalledError

    def told(part: str, note: str) -> None:
        print(f"rmfs: {inputs[part]}: {note}", file=sys.stderr)

    with progress(f"simulating {', '.join(inputs.values())}, seed {seed}") as advance:
        try:
            return simulate(*inputs.values(), seed=seed, progress=advance, remark=told, **options)
        except (StalledError, OptimiserError, ReplayError) as error:
            print(f"rmfs: {error}", file=sys.stderr)
            raise typer.Exit(GIVEN_UP) from None


def default_name(inputs: dict[str, str], seed: int) -> str:
    """Return the name of the run folder: layout-scenario-controllers-seedN."""
    return "-".join([*(Path(given).stem for given in inputs.values()), f"seed{seed}"])


def proven(done: Run) -> CheckReport:
    """Check the trace of a run."""
    step("checking the trace")
    return done.check()


def conclude(target: Path, report: CheckReport | None) -> None:
    """Print the main figures; an unsafe trace or a score above 1 is a defect: exit code 1."""
    from rich.console import Console

    from rmfs.measure import load_run
    from rmfs.measure.summary import summary

    footprint = load_run(target).footprint
    Console(highlight=False).print(summary(footprint))
    print(target)
    if footprint["units_score"] > 1.0:
        print("rmfs: more units were picked than is possible: a defect", file=sys.stderr)
        raise typer.Exit(UNSAFE)
    if report is not None and not report.ok:
        print(f"rmfs: {report.summary()}", file=sys.stderr)
        raise typer.Exit(UNSAFE)


def step(text: str) -> None:
    """Say what is done now, where no progress bar says it."""
    if not sys.stderr.isatty():
        print(f"rmfs: {text}", file=sys.stderr, flush=True)


@contextmanager
def progress(text: str) -> Iterator[Callable[[float, float], None]]:
    """Yield a function that is told (done, total): a bar on a terminal, one line elsewhere.

    The line is printed at the first call: what is wrong with the input is noticed before.
    """
    if not sys.stderr.isatty():
        yield lambda done, total: None if done else step(text)
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        Progress,
        TaskProgressColumn,
        TextColumn,
        TimeRemainingColumn,
    )

    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn())
    console = Console(stderr=True)
    with Progress(*columns, TimeRemainingColumn(), console=console, transient=True) as bar:
        task = bar.add_task(text, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


if __name__ == "__main__":
    sys.exit(main())
