"""The command `rmfs experiment calibrate`."""

from __future__ import annotations

import json
from dataclasses import asdict
from decimal import Decimal
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rmfs.cli.options import ControllersOption, LayoutOption, ScenarioOption, SetOption
from rmfs.errors import InputError
from rmfs.experiments.opening import RESULTS
from rmfs.experiments.options import FileOption, Jobs

if TYPE_CHECKING:
    from rmfs.experiments.calibration.procedure import Calibration, Step
    from rmfs.experiments.tables import Table

NOT_FOUND = 1
"""Exit code if the maximum number of runs was too small to find a level."""

Range = tuple[float, float]


def calibrate(
    target: Annotated[float, typer.Option(help="Desired mean of the column.")],
    between: Annotated[
        Range,
        typer.Option(
            metavar="LOW HIGH", help="Range in which the value of the parameter is sought."
        ),
    ],
    layout: LayoutOption = "default",
    scenario: ScenarioOption = "default",
    controllers: ControllersOption = "default",
    set_: SetOption = None,
    pacing: Annotated[str, typer.Option(metavar="MODE", help="As in rmfs run.")] = "instant",
    key: Annotated[
        str, typer.Option(help="Parameter to calibrate.")
    ] = "scenario.demand.orders_per_h",
    column: Annotated[
        str,
        typer.Option(
            "--column", "-c", help="Column of the footprint whose mean is to reach the target."
        ),
    ] = "on_time_share",
    tolerance: Annotated[
        float, typer.Option(help="Maximum deviation of the mean from the target.")
    ] = 0.02,
    confidence: Annotated[
        float, typer.Option(help="Probability that the deviation is within the tolerance.")
    ] = 0.95,
    search_seeds: Annotated[
        int, typer.Option(help="Number of seeds for each value of the parameter in the search.")
    ] = 4,
    test_seeds: Annotated[
        int,
        typer.Option(
            help="Initial number of seeds in a test of a value; each test uses new seeds."
        ),
    ] = 10,
    first_seed: Annotated[int, typer.Option(help="Smallest seed.")] = 0,
    most_runs: Annotated[int, typer.Option(help="Maximum number of runs.")] = 2000,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Folder of the runs. [default: results/calibrate-COLUMN]", show_default=False
        ),
    ] = None,
    jobs: Jobs = None,
    file: FileOption = None,
) -> None:
    """Find the arrival rate at which a given share of orders is on time, with a stated confidence.

    Instead of the arrival rate, another numerical parameter can be chosen (--key), and instead of
    the share of orders on time, another column of the footprint (--column). The mean of the column
    must rise or fall monotonically with the parameter. If the command is interrupted and repeated,
    finished runs are reused. The exit code is 1 if the maximum number of runs was too small.
    """
    from rmfs.config import parse_override
    from rmfs.experiments.calibration.procedure import Goal
    from rmfs.experiments.calibration.procedure import calibrate as found_by
    from rmfs.experiments.calibration.runs import Runs
    from rmfs.experiments.console import open_console

    low, high = between
    goal = Goal(
        target,
        tolerance,
        low,
        high,
        confidence,
        search_seeds=search_seeds,
        test_seeds=test_seeds,
        most_runs=most_runs,
        first_seed=first_seed,
    )
    changes = {".".join(path): value for path, value in map(parse_override, set_ or [])}
    if key in changes:
        raise InputError(f"--set {key}: is the parameter to calibrate")
    inputs = {"layout": layout, "scenario": scenario, "controllers": controllers}
    base: dict[str, Any] = {**inputs, "pacing": pacing, **changes}
    folder = out if out is not None else RESULTS / f"calibrate-{column}"
    respond = Runs(base, key, column, folder, jobs)
    for level in between:
        respond.plan(level, [first_seed])
    found = found_by(goal, respond, _tell)
    table = steps_table(found, key, column)
    open_console().print(table.rich())
    if file is not None:
        table.write(file)
    _write(found, base, key, column, folder / "calibration.json")
    typer.echo(verdict(found, key, column))
    if not found.found:
        raise typer.Exit(NOT_FOUND)


def verdict(found: Calibration, key: str, column: str) -> str:
    """Return the result of a calibration as a sentence."""
    goal = found.goal
    if not found.found:
        return (
            f"not found: {goal.most_runs} runs are not enough for {column} = {goal.target:g} "
            f"within {goal.tolerance:g}; raise --most-runs or --tolerance"
        )
    tested = found.steps[-1]
    return (
        f"{key} = {found.level:g}: {column} is {goal.target:g} within {goal.tolerance:g} with "
        f"confidence {100 * goal.confidence:g}% ({found.mean:.4g} +- {found.half_width:.2g} in the "
        f"test, {tested.seeds} seeds; {found.runs} runs in total)"
    )


def steps_table(found: Calibration, key: str, column: str) -> Table:
    """Return the steps of a calibration as a table, one row per step."""
    import pandas as pd

    from rmfs.experiments.tables import HALF, Table

    rows = [
        {
            ("phase", ""): step.phase,
            (key, ""): step.level,
            ("seeds", ""): f"{step.first_seed} to {step.first_seed + step.seeds - 1}",
            (column, "mean"): step.mean,
            (column, HALF): step.half_width,
            ("verdict", ""): step.verdict,
        }
        for step in found.steps
    ]
    frame = pd.DataFrame(rows, index=pd.RangeIndex(1, len(rows) + 1, name="step"))
    frame.columns = pd.MultiIndex.from_tuples([*rows[0]])
    goal = found.goal
    caption = (
        f"Target: {column} = {goal.target:g} within {goal.tolerance:g}, confidence "
        f"{100 * goal.confidence:g}%. The search compares means over the same few seeds. A test "
        "uses new seeds, and its interval allows for all earlier tests."
    )
    # a level is typed again as it is shown here
    places = [-int(Decimal(f"{step.level:g}").as_tuple().exponent) for step in found.steps]
    decimals = {(key, ""): max(0, *places), (column, "mean"): 4, (column, HALF): 4}
    return Table(frame, decimals, caption)


def _tell(step: Step) -> None:
    half = f" +- {step.half_width:.2g}" if step.phase == "test" else ""
    typer.echo(
        f"rmfs: {step.phase} {step.level:g}: {step.mean:.4g}{half} ({step.seeds} seeds): "
        f"{step.verdict}",
        err=True,
    )


def _write(found: Calibration, base: dict[str, Any], key: str, column: str, path: Path) -> None:
    from rmfs.files import write_text

    told = {"key": key, "column": column, "base": base, **asdict(found)}
    write_text(path, json.dumps(told, indent=1, default=str) + "\n")
