"""`rmfs controllers`: list, show, check and import sets of controllers."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from rmfs import instances
from rmfs.config import parse_override
from rmfs.control import registry
from rmfs.control.problems import Problem
from rmfs.control.settings import load, load_with_notes
from rmfs.control.toml import to_toml
from rmfs.errors import InputError
from rmfs.files import write_text

app = typer.Typer(
    name="controllers",
    help="List, show, check and import sets of controllers.",
    no_args_is_help=True,
)

Name = Annotated[str, typer.Argument(help="A .toml or .xconf file, or the name of a shipped set.")]


@app.command("list")
def list_controllers(
    rules: Annotated[
        bool,
        typer.Option(
            "--rules", help="List all controllers by decision problem, instead of the sets."
        ),
    ] = False,
) -> None:
    """List the shipped sets of controllers, or all available controllers."""
    Console().print(_rules() if rules else _sets())


@app.command()
def show(
    controllers: Name,
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="Set a parameter, as in `rmfs run`."),
    ] = None,
) -> None:
    """Print a set of controllers as TOML, with all parameters explained in comments."""
    overrides = [_below_controllers(text) for text in settings or []]
    read, notes = load_with_notes(controllers, overrides)
    _print_notes(notes)
    typer.echo(to_toml(read), nl=False)


@app.command()
def check(controllers: Name) -> None:
    """Check a set of controllers, and list the controllers that it selects."""
    read, notes = load_with_notes(controllers)
    _print_notes(notes)
    choices = read.choices.values()
    named = ", ".join(f"{choice.problem} {choice.name}" for choice in choices)
    typer.echo(f"{controllers}: ok, {named}")


@app.command("import")
def import_command(
    path: Annotated[
        Path, typer.Argument(metavar="FILE", help="RAWSim-O controller configuration (.xconf).")
    ],
    out: Annotated[
        Path | None, typer.Option(help="The .toml file to write. [default: NAME.toml]")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that exists.")] = False,
) -> None:
    """Convert a RAWSim-O controller configuration; report what is left out and what differs."""
    if path.suffix.lower() != ".xconf":
        raise InputError(f"{path}: expected a .xconf file")
    target = out if out is not None else Path(f"{path.stem}.toml")
    if target.suffix.lower() != ".toml":
        raise InputError(f"{target}: the name must end in .toml")
    if target.exists() and not force:
        raise InputError(f"{target}: exists already; --force replaces it")
    read, notes = load_with_notes(path)
    write_text(target, to_toml(read))
    _print_notes(notes)
    typer.echo(f"{target}: written")


def _print_notes(notes: list[str]) -> None:
    # on standard error: the output proper may be TOML
    for note in notes:
        typer.echo(f"note: {note}", err=True)


def _sets() -> Table:
    table = Table("name", "description", box=None)
    for name in instances.names("controllers"):
        table.add_row(name, load(name).description)
    return table


def _rules() -> Table:
    table = Table("problem", "rule", "what it does", box=None)
    for problem in Problem:
        for name in registry.names(problem):
            lines = (registry.find(problem, name).__doc__ or "").splitlines()
            table.add_row(problem, name, lines[0] if lines else "")
    return table


def _below_controllers(text: str) -> tuple[list[str], object]:
    """Parse one `--set`; its key starts with `controllers`, as in `rmfs run`."""
    path, value = parse_override(text)
    if path[0] != "controllers" or len(path) == 1:
        raise InputError(f"--set {text}: expected a key such as controllers.psa.name")
    return path[1:], value
