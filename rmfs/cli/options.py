"""Options that several commands have: what is run, and what is changed of it."""

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
