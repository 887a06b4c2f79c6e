"""`rmfs check`: whether layout, scenario and controllers go together, before anything runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

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
    layout: LayoutOption = "default",
    scenario: ScenarioOption = "default",
    controllers: ControllersOption = "default",
    set_: SetOption = None,
    allow_not_well_formed: NotWellFormedOption = False,
) -> None:
    """Say whether a run would be refused, and whether its fleet gets the energy it needs."""
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


def told_of_energy(layout: Layout, energy: Energy) -> list[str]:
    """Tell in lines what a fleet draws, and what it can get."""
    from rmfs.simulation.charging.balance import balance, working_w

    working = working_w(layout, energy)
    draws = f"{layout.robots} robots draw {layout.robots * energy.standby_w:g} W standing still"
    draws += f" and about {working:.0f} W at work"
    if energy.battery is None:
        return [f"energy: {draws}; they have as much as they need"]
    given = balance(layout, energy)
    lines = [f"energy: {draws}; chargers give {given.given_w:g} W at most"]
    if given.given_w < working:
        missing = working - given.given_w
        lines.append(f"energy: about {missing:.0f} W are missing in the long run at full work")
    if not given.has_stations:
        lines.append(
            "energy: only waypoints of queues charge: a robot that runs low elsewhere cannot be "
            "sent for energy, and strands"
        )
    return lines
