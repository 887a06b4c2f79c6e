"""`rmfs check`: checks the inputs before a run, and audits the files of a run after it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rmfs.cli.exit_codes import UNSAFE
from rmfs.cli.options import (
    ControllersOption,
    LayoutOption,
    NotWellFormedOption,
    ScenarioOption,
    SetOption,
)

if TYPE_CHECKING:
    from rmfs.layout.model import Layout
    from rmfs.scenario.parameters import Energy


def check(
    runs: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="[RUN]...",
            help="Run folders with a trace. Motion, stock, visits, orders, slots, bundles and "
            "tables of each run are audited from the files in its folder alone. Without a run "
            "folder, the inputs given by the options are checked.",
            show_default=False,
        ),
    ] = None,
    layout: LayoutOption = "default",
    scenario: ScenarioOption = "default",
    controllers: ControllersOption = "default",
    set_: SetOption = None,
    allow_not_well_formed: NotWellFormedOption = False,
) -> None:
    """Audit finished runs, or check the inputs of a run and the energy balance of its fleet."""
    if runs:
        audited(runs)
        return
    from rmfs.config import parse_override
    from rmfs.simulation.run import Simulation

    made = Simulation(
        layout,
        scenario,
        controllers,
        overrides=[parse_override(text) for text in set_ or []],
        allow_not_well_formed=allow_not_well_formed,
    )
    for note in [note for notes in made.inputs.notes.values() for note in notes]:
        typer.echo(f"note: {note}")
    energy = made.scenario.energy
    if energy is not None:
        for line in told_of_energy(made.layout, energy):
            typer.echo(line)
    typer.echo(f"{', '.join(made.names)}: ok")


def audited(folders: list[Path]) -> None:
    """Audit runs and print the findings; exit with code 1 if a run has an error."""
    from rmfs.measure import load_run
    from rmfs.measure.audit import audit

    wrong = False
    for folder in folders:
        found = audit(load_run(folder))
        wrong |= not found.ok
        if len(folders) > 1:
            typer.echo(f"{folder}:")
        typer.echo(found.summary())
    if wrong:
        raise typer.Exit(UNSAFE)


def told_of_energy(layout: Layout, energy: Energy) -> list[str]:
    """Return lines that describe the energy that a fleet draws and the energy available to it."""
    from rmfs.simulation.charging.balance import balance, working_w

    working = working_w(layout, energy)
    draws = f"{layout.robots} robots draw {layout.robots * energy.standby_w:g} W at standstill"
    draws += f" and about {working:.0f} W at work"
    if energy.battery is None:
        return [f"energy: {draws}; their energy is unlimited"]
    given = balance(layout, energy)
    lines = [f"energy: {draws}; chargers supply at most {given.given_w:g} W"]
    if given.given_w < working:
        missing = working - given.given_w
        lines.append(f"energy: in the long run about {missing:.0f} W are missing at full work")
    if not given.has_stations:
        lines.append(
            "energy: only queue waypoints charge, so a robot that runs low elsewhere cannot be "
            "sent to charge and strands"
        )
    return lines
