"""Options shared by several commands: what to run, and which parameters to change."""

from __future__ import annotations

from typing import Annotated

import typer

from rmfs.cli.groups import names_of

LayoutOption = Annotated[
    str,
    typer.Option(help="Name of a shipped layout, or a file.", autocompletion=names_of("layouts")),
]
ScenarioOption = Annotated[
    str,
    typer.Option(
        help="Name of a shipped scenario, or a file.", autocompletion=names_of("scenarios")
    ),
]
ControllersOption = Annotated[
    str,
    typer.Option(
        help="Name of a shipped set of controllers, or a file.",
        autocompletion=names_of("controllers"),
    ),
]
SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Override a parameter, for example layout.robots=16; may be repeated.",
    ),
]
NotWellFormedOption = Annotated[
    bool,
    typer.Option(
        "--allow-not-well-formed", help="Accept a layout in which robots may block each other."
    ),
]
