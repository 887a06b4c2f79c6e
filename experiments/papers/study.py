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
from rmfs import layout as layouts
from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import pandas as pd

    from experiments.design.arms import Arm
    from experiments.design.planning import Plan
    from experiments.tables import Table
    from rmfs.layout.model import Layout

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
    suffix
        Of their names: "-reference" where a layout of the reference took the place of its twin.
    """

    plan: Plan
    frame: pd.DataFrame
    folder: Path
    published: Path
    suffix: str = ""

    def table(self, name: str) -> pd.DataFrame:
        """Return a table that was kept of every run."""
        return load(self.folder, table=name)

    def publish(self, table: Table, name: str, columns: Sequence[str], **more: Any) -> None:
        """Write a table as Markdown, CSV and LaTeX, each with its provenance, and print it."""
        for ending in (".md", ".csv", ".tex"):
            path = self.place(f"{name}{ending}")
            table.write(path)
            self.record(path, columns, caption=table.caption, **more)
        print(table.markdown())

    def place(self, name: str) -> Path:
        """Return where a published file goes."""
        path = self.published / name
        return path.with_name(f"{path.stem}{self.suffix}{path.suffix}")

    def layout(self, arm: Arm) -> Layout:
        """Return the layout of an arm."""
        own = [(keys[1:], value) for keys, value in arm.overrides if keys[0] == "layout"]
        return layouts.load(arm.inputs["layout"], own)

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


def parser(
    design: str, description: str | None, *, reference: str | None = None
) -> argparse.ArgumentParser:
    """Return the options that all studies have.

    Parameters
    ----------
    design
        The shipped design.
    reference
        Layout of RAWSim-O that the study can be run on in place of its shipped twin: a path in the
        folder of its public instances.
    """
    made = argparse.ArgumentParser(description=(description or "").splitlines()[0])
    made.add_argument("--design", default=design, help=f"another design file (default: {design})")
    made.add_argument("--out", type=Path, help="folder of the runs (default: results/NAME)")
    made.add_argument(
        "--published", type=Path, default=PUBLISHED, help=f"folder of tables (default: {PUBLISHED})"
    )
    made.add_argument("--jobs", type=int, help="runs at a time (default: one per core)")
    made.add_argument("--dask", metavar="ADDRESS", help="a Dask scheduler or cluster profile")
    if reference is not None:
        made.add_argument(
            "--reference",
            type=Path,
            metavar="DIR",
            help=f"folder of RAWSim-O's public instances: take DIR/{reference} for the layout",
        )
        made.set_defaults(reference_layout=reference)
    return made


def done(given: argparse.Namespace) -> Study:
    """Run what is not finished of a study's design and return the results.

    Parameters
    ----------
    given
        Options of `parser`.

    Raises
    ------
    InputError
        If the design is wrong, or the folder of the reference lacks the layout.
    SystemExit
        If runs failed: a study with gaps is not published.
    """
    base, suffix = _reference(given)
    made = plan(given.design, base=base)
    folder = given.out if given.out is not None else RESULTS / f"{made.design.name}{suffix}"
    with watching(made.design.name) as watcher:
        tally = run(made, folder, processes=given.jobs, dask=given.dask, watcher=watcher)
    if tally.failed:
        print(f"{len(tally.failed)} runs failed: see {folder / 'failures'}", file=sys.stderr)
        raise SystemExit(FAILED)
    given.published.mkdir(parents=True, exist_ok=True)
    return Study(made, load(folder), folder, given.published, suffix)


def _reference(given: argparse.Namespace) -> tuple[dict[str, str] | None, str]:
    """Return the inputs that take the place of the design's, and the suffix of all names."""
    folder: Path | None = getattr(given, "reference", None)
    if folder is None:
        return None, ""
    layout = folder / given.reference_layout
    if not layout.is_file():
        raise InputError(f"--reference {folder}: {layout} is not there")
    return {"layout": str(layout.absolute())}, "-reference"


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
