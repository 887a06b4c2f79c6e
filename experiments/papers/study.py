"""What all reproduced experiments share: options, runs, and where results are published."""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from experiments import provenance
from experiments.design.planning import plan
from experiments.results import load
from experiments.running import run
from experiments.running.progress import watching
from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import pandas as pd

    from experiments.design.planning import Plan
    from experiments.tables import Table

PUBLISHED = Path("results") / "published"
RESULTS = Path("results")
FAILED = 1
WRONG_INPUT = 2
INTERRUPTED = 130


@dataclass(frozen=True)
class Study:
    """A design that has been run.

    Attributes
    ----------
    frame
        Its results.
    folder
        Where they are stored.
    published
        Where tables and pictures go.
    """

    plan: Plan
    frame: pd.DataFrame
    folder: Path
    published: Path

    def table(self, name: str) -> pd.DataFrame:
        """Return a table that was kept of every run."""
        return load(self.folder, table=name)

    def publish(self, table: Table, name: str, columns: Sequence[str], **more: Any) -> None:
        """Write a table as Markdown, CSV and LaTeX, each with its provenance, and print it."""
        for suffix in (".md", ".csv", ".tex"):
            path = self.published / f"{name}{suffix}"
            table.write(path)
            self.record(path, columns, caption=table.caption, **more)
        print(table.markdown())

    def record(self, path: Path, columns: Sequence[str], **more: Any) -> None:
        """Write the provenance of a table or picture."""
        provenance.write(
            path,
            self.frame,
            design=self.plan.design.name,
            design_hash=self.plan.hash,
            columns=columns,
            **more,
        )


def parser(design: str, description: str | None) -> argparse.ArgumentParser:
    """Return the options that all studies have."""
    made = argparse.ArgumentParser(description=(description or "").splitlines()[0])
    made.add_argument("--design", default=design, help=f"another design file (default: {design})")
    made.add_argument("--out", type=Path, help="folder of the runs (default: results/NAME)")
    made.add_argument(
        "--published", type=Path, default=PUBLISHED, help=f"folder of tables (default: {PUBLISHED})"
    )
    made.add_argument("--jobs", type=int, help="runs at a time (default: one per core)")
    made.add_argument("--dask", metavar="ADDRESS", help="a Dask scheduler or cluster profile")
    return made


def done(given: argparse.Namespace, base: Mapping[str, Any] | None = None) -> Study:
    """Run what is not finished of a study's design and return the results.

    Parameters
    ----------
    given
        Options of `parser`.
    base
        Inputs in place of those of the design.

    Raises
    ------
    InputError
        If the design is wrong.
    SystemExit
        If runs failed: a study with gaps is not published.
    """
    made = plan(given.design, base=base)
    folder = given.out if given.out is not None else RESULTS / made.design.name
    with watching(made.design.name) as watcher:
        tally = run(made, folder, processes=given.jobs, dask=given.dask, watcher=watcher)
    if tally.failed:
        print(f"{len(tally.failed)} runs failed: see {folder / 'failures'}", file=sys.stderr)
        raise SystemExit(FAILED)
    given.published.mkdir(parents=True, exist_ok=True)
    return Study(made, load(folder), folder, given.published)


def command(study: Callable[[list[str] | None], None], arguments: list[str] | None = None) -> int:
    """Run a study as a command and return its exit code."""
    try:
        study(arguments)
    except InputError as error:
        print(f"{' '.join(str(error).split())}", file=sys.stderr)
        return WRONG_INPUT
    except KeyboardInterrupt:
        print("interrupted; call again to go on", file=sys.stderr)
        return INTERRUPTED
    return 0
