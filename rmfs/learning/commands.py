"""`rmfs learn`: trains the weights of linear rules on simulated runs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rmfs.cli.options import SetOption
from rmfs.errors import InputError

app = typer.Typer(context_settings={"help_option_names": ["-h", "--help"]})


@app.command()
def learn(
    out: Annotated[Path, typer.Option(help="Controllers file to write (.toml).")],
    layout: Annotated[str, typer.Option(help="Name of a shipped layout, or a file.")] = "small",
    scenario: Annotated[str, typer.Option(help="Name of a shipped scenario, or a file.")] = "small",
    controllers: Annotated[
        str, typer.Option(help="Set of controllers, used for all problems that are not trained.")
    ] = "default",
    problems: Annotated[
        str, typer.Option(help="Problems to train: any of poa, pps, psa, ta, separated by commas.")
    ] = "poa,pps",
    objective: Annotated[
        str, typer.Option(help="Objective to maximise, as footprint columns: COLUMN=WEIGHT,...")
    ] = "units_picked=1",
    seeds: Annotated[str, typer.Option(help="Seeds of the runs, separated by commas.")] = "1,2,3",
    generations: Annotated[int, typer.Option(min=1, help="Number of generations.")] = 20,
    population: Annotated[
        int, typer.Option(min=4, help="Number of vectors of weights per generation.")
    ] = 10,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the search.")] = 1,
    jobs: Annotated[int, typer.Option(min=1, help="Number of processes.")] = 1,
    set_: SetOption = None,
) -> None:
    """Train linear rules by CMA-ES and write a controllers file for `rmfs run`."""
    from rmfs.config import parse_override
    from rmfs.control.toml import to_toml
    from rmfs.files import write_text
    from rmfs.learning.training import Task, named, train

    if out.suffix != ".toml":
        raise InputError(f"--out {out}: must be a .toml file")
    given = [parse_override(one) for one in set_ or []]
    task = Task(
        layout,
        scenario,
        controllers,
        problems.split(","),
        dict(weight("--objective", one) for one in objective.split(",")),
        [number(one) for one in seeds.split(",")],
        {".".join(path): value for path, value in given},
    )
    found = train(
        task, generations=generations, population=population, seed=seed, jobs=jobs, told=print
    )
    told = f"Trained by rmfs learn on {layout}, {scenario}: {objective}, seeds {seeds}."
    write_text(out, to_toml(named(found, out.stem, told)))
    print(
        f"{out}: mean objective over the training seeds {found.value:.6g} "
        f"(default weights: {found.start_value:.6g})"
    )


def weight(option: str, text: str) -> tuple[str, float]:
    """Return the name and the weight in `NAME=WEIGHT`, a part of an option's value."""
    column, _, weight = text.partition("=")
    try:
        return column.strip(), float(weight or 1.0)
    except ValueError:
        what = "COLUMN" if option == "--objective" else "NAME"
        raise InputError(f"{option} {text}: must be {what}=WEIGHT") from None


def number(text: str) -> int:
    """Return a seed of the option `--seeds`."""
    if not text.strip().isdigit():
        raise InputError(f"--seeds {text}: must be numbers, 0 or greater, separated by commas")
    return int(text)
