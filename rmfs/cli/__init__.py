"""The command line: the only part of rmfs that may import all others.

A user error is reported as one line on standard error, with exit code 2. An interruption ends with
exit code 130. A defect that the program detects is reported as one line, with exit code 1; the line
names a file with details, to be sent to the developers. Commands import their modules when they
run, so that help and errors appear without delay.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from rmfs.cli.check import check
from rmfs.cli.defects import told
from rmfs.cli.exit_codes import DEFECT, INTERRUPTED, WRONG_INPUT
from rmfs.cli.groups import LazyGroup, tell_defaults
from rmfs.cli.results import compare, plot, report, view
from rmfs.cli.simulate import run
from rmfs.cli.terminal import progress, step
from rmfs.errors import InputError, InternalError

app = typer.Typer(
    cls=LazyGroup,
    pretty_exceptions_enable=False,
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def main(arguments: list[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments
        Arguments without the program's name. Default: those of the process.

    Returns
    -------
    int
        The exit code.
    """
    command = tell_defaults(typer.main.get_command(app))
    try:
        code = command.main(args=arguments, prog_name="rmfs", standalone_mode=False)
    except InputError as error:
        return _complain(str(error))
    except OSError as error:  # errors for which no part of the program has a better message
        where = "" if error.filename is None else f"{error.filename!s:.200}: "
        return _complain(f"{where}{error.strerror or error}")
    except MemoryError:
        return _complain("not enough memory")
    except InternalError as error:
        _say(told(error, arguments))
        return DEFECT
    except typer.TyperException as error:
        # without a message: a group was called without a command and has shown its help
        return _complain(error.format_message()) if error.format_message() else 0
    except (KeyboardInterrupt, typer.Abort):
        _complain("interrupted")
        return INTERRUPTED
    if code == INTERRUPTED:
        _complain("interrupted")
    return code if isinstance(code, int) else 0


def _complain(message: str) -> int:
    """Report an error to the user in one line."""
    _say(message)
    return WRONG_INPUT


def _say(message: str) -> None:
    print(f"rmfs: {' '.join(message.split())}", file=sys.stderr)


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


for command in (run, check, plot, report, view, compare):
    app.command()(command)


@app.command()
def bench(
    runs: Annotated[
        int, typer.Option(min=1, help="Runs per case, of which the median is reported.")
    ] = 5,
    out: Annotated[Path, typer.Option(help="Folder for the tables.")] = Path("results/bench"),
) -> None:
    """Measure how fast runs are, and on which parts of the program they spend their time."""
    from rmfs.experiments import speed

    with progress("timing", wordy=False) as advance:
        frame = speed.table(runs=runs, tell=step, advance=advance)
    speed.save(frame, out)
    typer.echo(speed.to_markdown(frame))


@app.command("import")
def import_command(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="DIR",
            help="Folder with files of RAWSim-O, or a single such file.",
            exists=False,
        ),
    ],
    out: Annotated[
        Path | None,
        typer.Option(
            help="Folder to create. [default: below results/imported/]", show_default=False
        ),
    ] = None,
) -> None:
    """Import files of RAWSim-O; report what was left out, what differs, and what was refused."""
    from rmfs.rawsimo.folder import LIST, Imported, import_files

    def told(one: Imported) -> None:
        print(*one.lines(), sep="\n", flush=True)

    target = out or Path("results") / "imported" / source.resolve().stem
    done = import_files(source, target, told)
    print(target / LIST)
    if any(one.refused for one in done):
        raise typer.Exit(WRONG_INPUT)
