"""`rmfs scenario`: list, show and check scenarios."""

from __future__ import annotations

from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from rmfs import instances
from rmfs.config import parse_override
from rmfs.errors import InputError
from rmfs.scenario.loading import load
from rmfs.scenario.orders import OrderSource
from rmfs.scenario.skus import SkuSet, sku_set
from rmfs.scenario.toml import to_toml

app = typer.Typer(name="scenario", help="List, show and check scenarios.", no_args_is_help=True)

Name = Annotated[str, typer.Argument(help="A TOML file, or the name of a shipped scenario.")]


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
def show(
    scenario: Name,
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="Set a parameter, as in `rmfs run`."),
    ] = None,
) -> None:
    """Print all parameters of a scenario as TOML, defaults included and explained."""
    overrides = [_below_scenario(text) for text in settings or []]
    typer.echo(to_toml(load(scenario, overrides)), nl=False)


@app.command()
def check(scenario: Name) -> None:
    """Read a scenario and draw its SKUs, and say what is wrong or what it holds."""
    config = load(scenario)
    skus = sku_set(config.skus)
    OrderSource(config.orders, skus, seed=0, source=scenario)
    typer.echo(f"{scenario}: ok, {summary(skus)}")


def summary(skus: SkuSet) -> str:
    """Describe a SKU set in one line."""
    shares = sorted(skus.by_popularity.probabilities.tolist(), reverse=True)
    top = sum(shares[: max(1, len(shares) // 10)])
    smallest, largest = skus.bundle_space.min(), skus.bundle_space.max()
    return (
        f"{len(skus)} SKUs, the most popular tenth takes {top:.1%} of the demand, "
        f"bundles take {smallest:.3g} to {largest:.3g} space units"
    )


def _below_scenario(text: str) -> tuple[list[str], object]:
    """Read one `--set`; its key starts with `scenario`, as everywhere."""
    path, value = parse_override(text)
    if path[0] != "scenario" or len(path) == 1:
        raise InputError(f"--set {text}: expected a key such as scenario.duration_s")
    return path[1:], value
