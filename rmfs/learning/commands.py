"""`rmfs learn`: trains the weights of linear rules on simulated runs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rmfs.cli.options import SetOption
from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.learning.training import Task

app = typer.Typer(context_settings={"help_option_names": ["-h", "--help"]})


@app.command()
def learn(
    out: Annotated[Path, typer.Option(help="Controllers file to write (.toml).")],
    layout: Annotated[str, typer.Option(help="Name of a shipped layout, or a file.")] = "small",
    scenario: Annotated[str, typer.Option(help="Name of a shipped scenario, or a file.")] = "small",
    controllers: Annotated[
        str, typer.Option(help="Set of controllers; used for all problems that are not trained.")
    ] = "default",
    problems: Annotated[
        str, typer.Option(help="Problems to train: any of poa, pps, psa, ta, separated by commas.")
    ] = "poa,pps",
    objective: Annotated[
        str,
        typer.Option(
            help="Objective to maximise, a weighted sum of footprint columns: COLUMN=WEIGHT,..."
        ),
    ] = "units_picked=1",
    seeds: Annotated[str, typer.Option(help="Seeds of the runs, separated by commas.")] = "1,2,3",
    generations: Annotated[int, typer.Option(min=1, help="Number of generations.")] = 20,
    population: Annotated[
        int, typer.Option(min=4, help="Number of weight vectors per generation.")
    ] = 10,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the search.")] = 1,
    jobs: Annotated[int, typer.Option(min=1, help="Number of parallel processes.")] = 1,
    set_: SetOption = None,
) -> None:
    """Train linear rules by CMA-ES and write a controllers file for `rmfs run`."""
    from rmfs.control.toml import to_toml
    from rmfs.files import write_text
    from rmfs.learning.training import named, train

    require_toml(out)
    task = task_of((layout, scenario, controllers), problems, objective, seeds, set_)
    found = train(
        task, generations=generations, population=population, seed=seed, jobs=jobs, told=print
    )
    told = f"Trained by rmfs learn on {layout}, {scenario}: {objective}, seeds {seeds}."
    write_text(out, to_toml(named(found, out.stem, told)))
    print(
        f"{out}: mean objective over the training seeds {found.value:.6g} "
        f"(default weights: {found.start_value:.6g})"
    )


def require_toml(out: Path) -> None:
    """Check that the option `--out` names a TOML file.

    Raises
    ------
    InputError
        If the suffix is not `.toml`.
    """
    if out.suffix != ".toml":
        raise InputError(f"--out {out}: must be a .toml file")


def task_of(
    inputs: tuple[str, str, str],
    problems: str,
    objective: str,
    seeds: str,
    overrides: Sequence[str] | None,
) -> Task:
    """Return the training task that the options of a command describe.

    Parameters
    ----------
    inputs
        Layout, scenario and set of controllers, each as a name or a file.
    problems, objective, seeds, overrides
        Values of the options `--problems`, `--objective`, `--seeds` and `--set`.

    Raises
    ------
    InputError
        If a value is malformed; the message names the option.
    """
    from rmfs.config import parse_override
    from rmfs.learning.training import Task

    given = [parse_override(one) for one in overrides or []]
    return Task(
        *inputs,
        problems.split(","),
        dict(weight("--objective", one) for one in objective.split(",")),
        [number(one) for one in seeds.split(",")],
        {".".join(path): value for path, value in given},
    )


def weight(option: str, text: str) -> tuple[str, float]:
    """Split `NAME=WEIGHT`, a part of an option's value, into name and weight (1 if missing)."""
    column, _, weight = text.partition("=")
    try:
        return column.strip(), float(weight or 1.0)
    except ValueError:
        what = "COLUMN" if option == "--objective" else "NAME"
        raise InputError(f"{option} {text}: must be {what}=WEIGHT") from None


def number(text: str) -> int:
    """Convert one seed of the option `--seeds` to a number."""
    if not text.strip().isdigit():
        raise InputError(f"--seeds {text}: must be numbers, 0 or greater, separated by commas")
    return int(text)
