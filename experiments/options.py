"""Options and arguments shared by several commands of `rmfs experiment`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

Design = Annotated[
    str, typer.Argument(metavar="DESIGN", help="A design file, or the name of a shipped design.")
]
Made = Annotated[
    str,
    typer.Argument(
        metavar="DESIGN",
        help="A design file, the name of a shipped design, or a folder of results.",
    ),
]
Out = Annotated[
    Path | None,
    typer.Option(
        help="Folder of the results. [default: results/NAME, with the name of the design]",
        show_default=False,
    ),
]
Jobs = Annotated[
    int | None,
    typer.Option(
        "--jobs",
        "-j",
        min=1,
        help="Number of runs at a time. [default: one per core]",
        show_default=False,
    ),
]
Columns = Annotated[
    list[str] | None,
    typer.Option(
        "--column",
        "-c",
        help="Column of the footprint; may be repeated. [default: the main columns]",
        show_default=False,
    ),
]
Confidence = Annotated[
    float, typer.Option(min=0.5, max=0.999, help="Confidence level of the intervals.")
]
Interactions = Annotated[
    bool,
    typer.Option(
        "--interactions/--no-interactions",
        help="Also show interactions of two factors.",
    ),
]
Lacking = Annotated[
    bool,
    typer.Option(
        "--allow-incomplete",
        help="Exit with code 0 even if runs are missing; the note is still printed.",
    ),
]
Bootstrap = Annotated[
    bool,
    typer.Option(
        "--bootstrap", help="Use BCa bootstrap intervals instead of Student's t intervals."
    ),
]
FileOption = Annotated[
    Path | None,
    typer.Option("--file", "-f", help="Write the table to a .tex, .md, .csv or .html file."),
]
