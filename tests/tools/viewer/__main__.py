"""`python -m tests.tools.viewer`: speed, cost and pictures of the viewer."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from rmfs.errors import InputError

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False, help=__doc__)


@app.command()
def speed(
    seconds: Annotated[float, typer.Option(min=1, help="Wall time per view.")] = 5.0,
    run: Annotated[
        Path | None,
        typer.Option(help="Run folder with a trace. [default: 128 robots, 2,000 pods]"),
    ] = None,
    large: Annotated[bool, typer.Option("--large", help="2,000 robots, 20,000 pods.")] = False,
    card: Annotated[
        bool, typer.Option("--card", help="Draw nothing, as if a graphics card did it at no cost.")
    ] = False,
) -> None:
    """Measure the frames a second of every view, drawn in software."""
    from rmfs.measure import load_run
    from rmfs.view import scene
    from tests.tools.viewer.speed import SIZES, recorded, table

    size = SIZES["large" if large else "usual"]
    packed = recorded(size) if run is None else scene.of_run(load_run(run))
    print(table(packed, seconds, card=card).round(1).to_string(index=False))


@app.command()
def cost(
    rounds: Annotated[int, typer.Option(min=1, help="Runs of each kind.")] = 5,
    drawn: Annotated[bool, typer.Option("--drawn", help="With the page in Chromium too.")] = False,
) -> None:
    """Measure how much slower runs of some ten seconds are when a page watches them."""
    from tests.tools.viewer.live_cost import How, ratios, table

    frame = table(rounds, [how for how in How if drawn or how is not How.DRAWN])
    print(frame.round(3).to_string(index=False))
    print(ratios(frame).round(3).to_string())


@app.command()
def pictures(
    out: Annotated[Path, typer.Option(help="Folder.")] = Path("docs/images"),
) -> None:
    """Take the pictures of the documentation."""
    from tests.tools.viewer.pictures import take

    take(out, print)


if __name__ == "__main__":
    try:
        app()
    except InputError as error:
        sys.exit(f"rmfs: {error}")
