"""`python -m experiments.viewer`: speed, cost and pictures of the viewer."""

from __future__ import annotations

import sys
import tempfile
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
) -> None:
    """Measure the frames a second of every view, drawn in software."""
    from experiments.viewer.speed import recorded, table

    with tempfile.TemporaryDirectory() as parent:
        frame = table(run or recorded(Path(parent) / "run"), seconds)
    print(frame.round(1).to_string(index=False))


@app.command()
def cost(
    pairs: Annotated[int, typer.Option(min=1, help="Runs without and with a page.")] = 5,
    duration_s: Annotated[float, typer.Option(min=60, help="Simulated seconds.")] = 14_400.0,
) -> None:
    """Measure how much slower a run is when a page watches it."""
    from experiments.viewer.live_cost import table

    length = [(["scenario", "warmup_s"], 0.0), (["scenario", "duration_s"], duration_s)]
    frame = table(pairs, length)
    print(frame.round(3).to_string(index=False))
    print(f"median ratio of processor time: {frame['ratio'].median():.3f}")


@app.command()
def pictures(
    out: Annotated[Path, typer.Option(help="Folder.")] = Path("docs/images"),
) -> None:
    """Take the pictures of the documentation."""
    from experiments.viewer.pictures import take

    take(out, print)


if __name__ == "__main__":
    try:
        app()
    except InputError as error:
        sys.exit(f"rmfs: {error}")
