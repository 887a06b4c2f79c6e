"""`rmfs layout`: new, list, show, check, import, convert.

If the input is wrong, these functions raise `InputError`; the command line prints the message of
the error as one line and exits with code 2.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rmfs import instances
from rmfs.config import apply_overrides, parse_override, validate
from rmfs.errors import InputError
from rmfs.files import write_text
from rmfs.layout.checks import IMPOSSIBLE, check
from rmfs.layout.explicit import save_json
from rmfs.layout.loading import load, load_with_notes
from rmfs.layout.parameters import LayoutParameters
from rmfs.layout.toml import to_toml
from rmfs.rawsimo.layout.writing import SUFFIXES, import_layout

if TYPE_CHECKING:
    from rmfs.layout.model import Layout

app = typer.Typer(help="Generate, draw, check, import and convert layouts.", no_args_is_help=True)

LayoutArgument = Annotated[
    str,
    typer.Argument(
        metavar="LAYOUT",
        help="Name of a shipped layout, or a .toml, .json, .txt, .map, .xinst or .xlayo file.",
    ),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help="Override a parameter, e.g. robots=16; may be repeated."
    ),
]
Force = Annotated[bool, typer.Option("--force", help="Replace a file that exists.")]

EXIT_REFUSED = 2
MOST_MEASURED = 50_000
"""Maximum number of waypoints for which `check` computes measures of the graph; with this number,
it takes seconds."""


@app.command()
def new(
    path: Annotated[Path, typer.Argument(metavar="FILE", help="The .toml file to write.")],
    settings: Settings = None,
    force: Force = False,
) -> None:
    """Write a parameter file with all parameters, their defaults and their units."""
    _suffix(path, ".toml")
    _vacant(path, force=force)
    table = apply_overrides({"name": path.stem}, _overrides(settings))
    write_text(path, to_toml(validate(LayoutParameters, table, str(path))))
    typer.echo(f"{path}: written")


@app.command("list")
def list_layouts() -> None:
    """List the shipped layouts."""
    from rich.console import Console
    from rich.table import Table

    heads = ("name", "tiers", "robots", "pods", "pick", "replenish", "waypoints")
    table = Table(heads[0], box=None)
    for head in heads[1:]:
        table.add_column(head, justify="right")
    for name in instances.names("layouts"):
        layout = load(name)
        counts = (len(layout.tiers), layout.robots, layout.pods, len(layout.pick_stations))
        more = (len(layout.replenishment_stations), layout.waypoints)
        table.add_row(name, *(f"{count:,}" for count in (*counts, *more)))
    Console().print(table)


@app.command()
def show(
    layout: LayoutArgument,
    out: Annotated[
        Path | None, typer.Option(help="The .svg, .png or .pdf file to write. [default: NAME.svg]")
    ] = None,
    arrows: Annotated[bool, typer.Option("--arrows", help="Mark one-way edges by arrows.")] = False,
    settings: Settings = None,
) -> None:
    """Draw a layout."""
    from rmfs.layout.picture import save_picture  # matplotlib is slow to import

    loaded, _ = load_with_notes(layout, _overrides(settings))
    path = out if out is not None else Path(f"{Path(layout).stem}.svg")
    save_picture(loaded, path, arrows=arrows)
    typer.echo(f"{path}: written")


@app.command("check")
def check_command(
    layout: LayoutArgument,
    settings: Settings = None,
    allow_not_well_formed: Annotated[
        bool,
        typer.Option(
            "--allow-not-well-formed",
            help="Accept a layout in which robots may block each other; fail only if no run "
            "is possible.",
        ),
    ] = False,
) -> None:
    """Check a layout; the exit code is 2 if a run would refuse the layout."""
    loaded, notes = load_with_notes(layout, _overrides(settings))
    _print_notes(notes)
    violations = check(loaded)
    for violation in violations:
        typer.echo(str(violation))
    if any(v.severity == IMPOSSIBLE or not allow_not_well_formed for v in violations):
        raise typer.Exit(EXIT_REFUSED)
    verdict = "allowed" if violations else "well-formed"
    typer.echo(
        f"{layout}: {verdict}: {loaded.waypoints} waypoints, {len(loaded.edge_target)} edges, "
        f"{int(loaded.is_storage.sum())} storage locations, {loaded.pods} pods, "
        f"{loaded.robots} robots, {len(loaded.pick_stations)} pick stations, "
        f"{len(loaded.replenishment_stations)} replenishment stations, "
        f"{len(loaded.elevators)} elevators, {len(loaded.tiers)} tiers"
    )
    if loaded.waypoints <= MOST_MEASURED:
        _print_measures(loaded)


@app.command("import")
def import_command(
    path: Annotated[Path, typer.Argument(metavar="FILE", help="RAWSim-O .xinst or .xlayo file.")],
    out: Annotated[
        Path | None, typer.Option(help="The file to write. [default: NAME.json or NAME.toml]")
    ] = None,
    force: Force = False,
) -> None:
    """Convert a RAWSim-O layout: .xinst to .json, .xlayo to .toml."""
    target = out if out is not None else Path(path.stem + SUFFIXES.get(path.suffix.lower(), ""))
    _vacant(target, force=force)
    notes = import_layout(path, target)
    _print_notes(notes)
    typer.echo(f"{target}: written")


@app.command()
def convert(
    layout: LayoutArgument,
    out: Annotated[
        Path | None, typer.Option(help="The .json file to write. [default: NAME.json]")
    ] = None,
    settings: Settings = None,
    force: Force = False,
) -> None:
    """Convert a layout to an explicit layout (.json), which lists all waypoints."""
    loaded, notes = load_with_notes(layout, _overrides(settings))
    target = out if out is not None else Path(f"{Path(layout).stem}.json")
    _suffix(target, ".json")
    _vacant(target, force=force)
    save_json(loaded, target)
    _print_notes(notes)
    typer.echo(f"{target}: written")


def _overrides(settings: list[str] | None) -> list[tuple[list[str], Any]]:
    """Parse `--set`; the prefix "layout." of `rmfs run` is accepted here too."""
    parsed = [parse_override(text) for text in settings or []]
    return [(path[1:] if path[0] == "layout" else path, value) for path, value in parsed]


def _suffix(path: Path, suffix: str) -> None:
    if path.suffix.lower() != suffix:
        raise InputError(f"{path}: the name must end in {suffix}")


def _vacant(path: Path, *, force: bool) -> None:
    if path.exists() and not force:
        raise InputError(f"{path}: exists already; --force replaces it")


def _print_measures(layout: Layout) -> None:
    from rmfs.layout.networkx_graph import measures

    found = measures(layout)
    if found.to_station_mean_m is not None:
        typer.echo(
            "distance from a storage location to the nearest pick station: "
            f"{found.to_station_mean_m:.1f} m on average, at most {found.to_station_max_m:.1f} m"
        )
    typer.echo(f"waypoints whose closure would disconnect the floor: {found.bottlenecks}")


def _print_notes(notes: list[str]) -> None:
    for note in notes:
        typer.echo(f"note: {note}")
