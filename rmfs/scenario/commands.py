"""`rmfs scenario`: list, show, check, import, export and fit scenarios; describe their SKUs."""

from __future__ import annotations

import math
from contextlib import nullcontext
from datetime import datetime
from pathlib import Path
from typing import Annotated, Literal

import typer
from rich.console import Console
from rich.table import Table

from rmfs import foreign, instances
from rmfs.config import parse_override
from rmfs.errors import InputError
from rmfs.scenario.intake import Site, bundle_intake, export_stream, order_intake
from rmfs.scenario.loading import load, load_with_notes
from rmfs.scenario.parameters import Scenario, SkuFile, StreamDemand, StreamReplenishment
from rmfs.scenario.pick_times import UnitTimes
from rmfs.scenario.skus import SkuSet, write_sku_set
from rmfs.scenario.sources import sku_set
from rmfs.scenario.streams import digest
from rmfs.scenario.toml import to_toml
from rmfs.scenario.writing import write_scenario

app = typer.Typer(
    name="scenario",
    help="List, show, check, import, fit and export scenarios.",
    no_args_is_help=True,
)

Name = Annotated[
    str,
    typer.Argument(
        metavar="SCENARIO", help="A .toml or .xsett file, or the name of a shipped scenario."
    ),
]
Settings = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Set a parameter, as in `rmfs run`."),
]
MOMENTS = ["%Y-%m-%d", "%Y-%m-%dT%H:%M:%S"]
Force = Annotated[bool, typer.Option("--force", help="Replace a file that exists.")]


@app.command("list")
def list_scenarios() -> None:
    """List the shipped scenarios."""
    table = Table("name", "duration_s", "warmup_s", "description", box=None)
    for name in instances.names("scenarios"):
        scenario = load(name)
        times = f"{scenario.duration_s:g}", f"{scenario.warmup_s:g}"
        table.add_row(name, *times, scenario.description)
    Console().print(table)


@app.command()
def show(scenario: Name, settings: Settings = None) -> None:
    """Print all parameters of a scenario as TOML, including defaults, with explanations."""
    typer.echo(to_toml(_loaded(scenario, settings)), nl=False)


@app.command()
def check(scenario: Name, settings: Settings = None) -> None:
    """Check a scenario and its files; print the error or, if there is none, a summary."""
    from rmfs.cli.terminal import progress

    config = _loaded(scenario, settings)
    skus = sku_set(config.skus)
    anywhere = Site(1, 1, capacity=math.inf, largest_pod=math.inf)
    streams = (config.demand, config.replenishment)
    files = [s.file.name for s in streams if isinstance(s, StreamDemand | StreamReplenishment)]
    told = f"reading {' and '.join(files)}"
    with progress(told, wordy=False) if files else nullcontext():
        orders = order_intake(config, skus, anywhere, seed=0).stream
        bundles = bundle_intake(config, skus, anywhere, seed=0).stream
    if config.pickers is not None:
        UnitTimes(config.pickers.unit_time)
    typer.echo(f"{scenario}: ok, {summary(skus)}")
    if orders is not None:
        typer.echo(f"{len(orders)} orders, digest {digest(orders, skus)}")
    if bundles is not None:
        typer.echo(f"{len(bundles)} bundles, digest {digest(bundles, skus)}")


@app.command("import")
def import_command(
    path: Annotated[Path, typer.Argument(metavar="FILE", help="RAWSim-O scenario (.xsett).")],
    out: Annotated[
        Path | None, typer.Option(help="The .toml file to write. [default: NAME.toml]")
    ] = None,
    force: Force = False,
) -> None:
    """Convert a RAWSim-O scenario, together with its SKUs and orders."""
    if path.suffix.lower() != ".xsett":
        raise InputError(f"{path}: expected a .xsett file")
    target = out if out is not None else Path(f"{path.stem}.toml")
    _vacant(target, force=force)
    for written in write_scenario(_loaded(str(path), None), target):
        typer.echo(f"{written}: written")


@app.command()
def convert(
    layout: Annotated[
        str,
        typer.Argument(metavar="LAYOUT", help="Data set: instacart, online-retail, jd or olist."),
    ],
    files: Annotated[
        list[Path], typer.Argument(metavar="FILE...", help="The .csv files of the data set.")
    ],
    out: Annotated[Path, typer.Option(help="The .csv file of orders to write.")] = Path(
        "orders.csv"
    ),
    begin: Annotated[
        datetime | None,
        typer.Option(
            "--from", formats=MOMENTS, help="Use orders from this time on. [default: all]"
        ),
    ] = None,
    end: Annotated[
        datetime | None,
        typer.Option("--to", formats=MOMENTS, help="Use orders before this time. [default: all]"),
    ] = None,
    share: Annotated[
        float, typer.Option(min=1e-6, max=1.0, help="Share of the orders to use, drawn at random.")
    ] = 1.0,
    seed: Annotated[int, typer.Option(min=0, help="Seed for the draw of orders.")] = 0,
    force: Force = False,
) -> None:
    """Convert a public data set, which you have downloaded, to a file of orders."""
    from rmfs.scenario.datasets import convert as converted

    _vacant(out, force=force)
    done = converted(layout, files, out, begin=begin, end=end, share=share, seed=seed)
    typer.echo(
        f"{out}: {done.orders} orders, {done.lines} lines, {done.units} units, {done.skus} SKUs, "
        f"from {done.first} to {done.last}"
    )
    for what, number in done.left_out.items():
        typer.echo(f"left out: {number} {what}")


@app.command()
def twin(
    orders: Annotated[
        Path, typer.Argument(metavar="ORDERS", help="A .csv or .parquet file of orders.")
    ],
    out: Annotated[Path, typer.Option(help="The .toml file to write.")] = Path("twin.toml"),
    table: Annotated[
        Path | None,
        typer.Option(
            help="The .csv file to write, with the parameters, their 95 % intervals, and tests of "
            "the fit. [default: none]",
            show_default=False,
        ),
    ] = None,
    weekly: Annotated[
        bool,
        typer.Option(
            "--weekly",
            help="Fit an arrival rate to each hour of the week instead of each hour of the day.",
        ),
    ] = False,
    listed: Annotated[
        bool,
        typer.Option(
            "--listed",
            help="Store the popularity of each SKU (without the name of the SKU) in a file beside "
            "the scenario, instead of fitting a gamma distribution.",
        ),
    ] = False,
    seed: Annotated[
        int, typer.Option(min=0, help="Seed for the SKUs that the scenario generates.")
    ] = 0,
    force: Force = False,
) -> None:
    """Fit a scenario to a file of orders; the scenario can be published instead of the file."""
    from rmfs.scenario.twin import fit_twin
    from rmfs.scenario.twin.telling import told, write_table, write_twin

    beside = out.with_name(f"{out.stem}-skus.json") if listed else None
    for target in (out, table, beside):
        if target is not None:
            _vacant(target, force=force)
    if out.suffix.lower() != ".toml":
        raise InputError(f"{out}: must end in .toml")
    found = fit_twin(orders, out.stem, weekly=weekly, listed=listed, seed=seed)
    write_twin(found, out)
    if table is not None:
        write_table(found, table)
    Console().print(told(found))
    typer.echo(f"{out}: written")


@app.command()
def export(
    scenario: Name,
    path: Annotated[
        Path, typer.Argument(metavar="FILE", help="The .csv or .parquet file to write.")
    ],
    what: Annotated[
        Literal["orders", "bundles"], typer.Option(help="Which stream to write.")
    ] = "orders",
    seed: Annotated[int, typer.Option(min=0, help="Seed of all random streams.")] = 0,
    pick_stations: Annotated[
        int, typer.Option(min=1, help="Number of pick stations; needed for rates per station.")
    ] = 4,
    replenishment_stations: Annotated[
        int,
        typer.Option(min=1, help="Number of replenishment stations; needed for rates per station."),
    ] = 4,
    settings: Settings = None,
    force: Force = False,
) -> None:
    """Write the orders or bundles of a scenario to a file, if they do not depend on the run."""
    _vacant(path, force=force)
    site = Site(pick_stations, replenishment_stations, capacity=math.inf, largest_pod=math.inf)
    written = export_stream(_loaded(scenario, settings), what, path, site, seed)
    typer.echo(f"{written.path}: {written.number} {what}, digest {written.digest}")


@app.command("sku-set")
def sku_set_command(
    scenario: Annotated[
        str,
        typer.Argument(
            metavar="SCENARIO",
            help="A scenario, or a file with a SKU set (.json, .xgenc or .xitem).",
        ),
    ],
    out: Annotated[Path | None, typer.Option(help="The .json file (rmfs-skus/1) to write.")] = None,
    picture: Annotated[
        Path | None,
        typer.Option(help="The .svg, .png or .pdf file to write, with the popularity curve."),
    ] = None,
    settings: Settings = None,
    force: Force = False,
) -> None:
    """Describe the SKUs of a scenario or file; optionally write them or plot their popularity."""
    skus = _skus(scenario, settings)
    typer.echo(f"{scenario}: {summary(skus)}, digest {skus.digest()}")
    if out is not None:
        _vacant(out, force=force)
        write_sku_set(skus, out)
        typer.echo(f"{out}: written")
    if picture is not None:
        from rmfs.scenario.skus.picture import save_picture  # matplotlib is slow to import

        _vacant(picture, force=force)
        save_picture(skus, picture)
        typer.echo(f"{picture}: written")


def summary(skus: SkuSet) -> str:
    """Return a line that describes a SKU set."""
    shares = sorted(skus.by_popularity.probabilities.tolist(), reverse=True)
    top = sum(shares[: max(1, len(shares) // 10)])
    smallest, largest = skus.bundle_space.min(), skus.bundle_space.max()
    return (
        f"{len(skus)} SKUs, the most popular tenth takes {top:.1%} of the demand, "
        f"bundles take {smallest:.3g} to {largest:.3g} space units"
    )


def _skus(scenario: str, settings: list[str] | None) -> SkuSet:
    path = Path(scenario)
    if path.suffix.lower() not in (".json", ".xgenc", ".xitem"):
        return sku_set(_loaded(scenario, settings).skus)
    if not path.is_file():
        raise InputError(f"{path}: no such file")
    if path.suffix.lower() == ".xitem":
        _print_notes(foreign.read(path).notes)
    return sku_set(SkuFile(file=path))


def _loaded(scenario: str, settings: list[str] | None) -> Scenario:
    """Load a scenario and print the notes of its import."""
    config, notes = load_with_notes(scenario, [_below_scenario(text) for text in settings or []])
    _print_notes(notes)
    return config


def _below_scenario(text: str) -> tuple[list[str], object]:
    """Parse one `--set`; its key starts with `scenario`, as in `rmfs run`."""
    path, value = parse_override(text)
    if path[0] != "scenario" or len(path) == 1:
        raise InputError(f"--set {text}: expected a key such as scenario.duration_s")
    return path[1:], value


def _print_notes(notes: list[str] | tuple[str, ...]) -> None:
    # on standard error: the output proper may be TOML
    for note in notes:
        typer.echo(f"note: {note}", err=True)


def _vacant(path: Path, *, force: bool) -> None:
    if path.exists() and not force:
        raise InputError(f"{path}: exists already; --force replaces it")
