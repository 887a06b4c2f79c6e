"""Opening an experiment, given a design file, the name of a shipped design, or its results."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    import pandas as pd

    from rmfs.experiments.design.planning import Plan
    from rmfs.experiments.store import Store

RESULTS = Path("results")


@dataclass(frozen=True)
class Opened:
    """An experiment with the folder of its results.

    Attributes
    ----------
    name
        The design or folder as the user specified it.
    """

    name: str
    plan: Plan
    store: Store

    def rows(self) -> tuple[pd.DataFrame, str]:
        """Return the finished runs, and a note on missing runs (empty if none are missing).

        Raises
        ------
        InputError
            If there are no finished runs.
        """
        from rmfs.experiments.complete import lacking
        from rmfs.experiments.results import assigned

        frame = assigned(self.plan, self.store)
        if frame.empty:
            raise InputError(
                f"{self.store.folder}: no finished runs yet; rmfs experiment run {self.name}"
            )
        return frame, lacking(self.plan, self.store, rows=frame)


def opened(design: str, out: Path | None = None) -> Opened:
    """Open an experiment; if its design has errors, print them and exit with code 2.

    Parameters
    ----------
    design
        A design file, the name of a shipped design, or a folder of results, which contains the
        plan.
    out
        The folder of results, unless `design` is a folder itself. Default: `results/NAME`, with the
        name stated in the design.

    Raises
    ------
    InputError
        If there is no such design, if the folder `design` contains no experiment, or if `design` is
        a folder and `out` is also given.
    """
    from rmfs.experiments.design import planning
    from rmfs.experiments.store import Store

    folder = Path(design)
    if folder.is_dir():
        if out is not None:
            raise InputError(f"--out: {design} cannot be combined with a folder of results")
        return Opened(design, planning.load(folder), Store(folder))
    made = planning.plan(design)
    refuse(made)
    return Opened(design, made, Store(out if out is not None else RESULTS / made.design.name))


def refuse(made: Plan) -> None:
    """If a plan has errors, print them, one line each, and exit with code 2."""
    if made.problems:
        for problem in made.problems:
            typer.echo(f"rmfs: {made.source}: {' '.join(problem.split())}", err=True)
        raise typer.Exit(2)


def shipped() -> Iterator[tuple[str, str]]:
    """Yield the name and description of every shipped design."""
    from rmfs.experiments.design import file

    for path in sorted(file.SHIPPED.glob("*.toml")):
        yield path.stem, file.read(path)[0].description


def made_below(folder: Path) -> Iterator[Opened]:
    """Yield the experiments whose results are in a folder or one of its direct subfolders."""
    from rmfs.experiments.design import planning
    from rmfs.experiments.store import Store

    for path in sorted({*folder.glob(planning.FILE), *folder.glob(f"*/{planning.FILE}")}):
        yield Opened(str(path.parent), planning.load(path.parent), Store(path.parent))
