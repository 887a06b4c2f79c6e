"""`rmfs learn-network`: trains network rules on simulated runs, by PPO."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rmfs.cli.options import SetOption
from rmfs.learning.commands import require_toml, task_of, weight

app = typer.Typer(context_settings={"help_option_names": ["-h", "--help"]})


@app.command()
def learn_network(
    out: Annotated[Path, typer.Option(help="Controllers file to write (.toml).")],
    layout: Annotated[str, typer.Option(help="Name of a shipped layout, or a file.")] = "small",
    scenario: Annotated[str, typer.Option(help="Name of a shipped scenario, or a file.")] = "small",
    controllers: Annotated[
        str,
        typer.Option(
            help="Set of controllers; used for all problems that are not trained. For the others, "
            "training starts from the network rules of the set, if it has any."
        ),
    ] = "default",
    problems: Annotated[
        str, typer.Option(help="Problems to train: any of poa, pps, psa, ta, separated by commas.")
    ] = "poa,pps,psa,ta",
    reward: Annotated[
        str,
        typer.Option(
            help="Reward that PPO maximises, a weighted sum of named rewards: NAME=WEIGHT,..."
        ),
    ] = "units=1",
    steps: Annotated[
        int,
        typer.Option(
            min=1, help="Number of decisions in training, rounded up to a multiple of 2048."
        ),
    ] = 200_000,
    objective: Annotated[
        str,
        typer.Option(
            help="Objective by which the best rules are selected, a weighted sum of footprint "
            "columns: COLUMN=WEIGHT,..."
        ),
    ] = "units_picked=1",
    seeds: Annotated[
        str,
        typer.Option(
            help="Seeds of the runs in which the objective is computed, separated by commas."
        ),
    ] = "1,2,3",
    checks: Annotated[
        int,
        typer.Option(min=1, help="Number of times during training that the objective is computed."),
    ] = 10,
    hidden: Annotated[int, typer.Option(min=1, help="Number of neurons in the hidden layer.")] = 16,
    candidates: Annotated[
        int, typer.Option(min=1, help="Maximum number of candidates that are scored per decision.")
    ] = 16,
    gamma: Annotated[float, typer.Option(help="Discount factor per decision.")] = 0.99,
    learning_rate: Annotated[float, typer.Option(help="Initial learning rate.")] = 1e-3,
    average: Annotated[
        bool,
        typer.Option(
            "--average",
            help="Subtract from each reward the mean reward per second times the seconds since "
            "the last decision.",
        ),
    ] = False,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the weights and of PPO.")] = 1,
    set_: SetOption = None,
) -> None:
    """Train network rules by PPO and write a controllers file for `rmfs run`."""
    from rmfs.control.toml import to_toml
    from rmfs.files import write_text
    from rmfs.learning.ppo import train_network
    from rmfs.learning.training import named

    require_toml(out)
    task = task_of((layout, scenario, controllers), problems, objective, seeds, set_)
    found = train_network(
        task,
        reward=dict(weight("--reward", one) for one in reward.split(",")),
        steps=steps,
        hidden=hidden,
        candidates=candidates,
        gamma=gamma,
        learning_rate=learning_rate,
        checks=checks,
        average=average,
        seed=seed,
        told=print,
    )
    made = found.history["steps"].iloc[-1]
    told = (
        f"Trained by rmfs learn-network on {layout}, {scenario}: reward {reward}"
        f"{', less its mean,' if average else ','} {made} decisions, seed {seed}; "
        f"objective {objective}, seeds {seeds}."
    )
    write_text(out, to_toml(named(found, out.stem, told)))
    print(
        f"{out}: mean objective over the seeds {found.value:.6g} (before training: "
        f"{found.start_value:.6g}); {found.history['cpu_s'].iloc[-1]:.0f} s of processor time"
    )
