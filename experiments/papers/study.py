"""Shared parts of the studies: options, runs, and publication of results."""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs import layout as layouts
from rmfs.errors import InputError
from rmfs.experiments import provenance
from rmfs.experiments.design.planning import plan
from rmfs.experiments.results import load
from rmfs.experiments.running import run
from rmfs.experiments.running.progress import watching

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping, Sequence

    import pandas as pd

    from rmfs.experiments.design.arms import Arm
    from rmfs.experiments.design.planning import Plan
    from rmfs.experiments.tables import Table
    from rmfs.layout.model import Layout

PUBLISHED = Path("results") / "published"
RESULTS = Path("results")
_SMOKE = "-smoke"
SMOKE = {"scenario.duration_s": 300.0, "scenario.warmup_s": 0.0}
FAILED = 1
WRONG_INPUT = 2
INTERRUPTED = 130


@dataclass(frozen=True)
class Study:
    """A design that has been run.

    Attributes
    ----------
    frame
        The results.
    folder
        Folder in which the results are stored.
    published
        Folder for tables and pictures.
    suffix
        Suffix of the names of tables and pictures: "-reference" if a layout of RAWSim-O was used
        instead of the generated layout of the same size, followed by "-smoke" if runs are short.
    """

    plan: Plan
    frame: pd.DataFrame
    folder: Path
    published: Path
    suffix: str = ""

    @property
    def smoke(self) -> bool:
        """Whether the runs are short and only check that everything works."""
        return self.suffix.endswith(_SMOKE)

    def table(self, name: str) -> pd.DataFrame:
        """Return a table that the design keeps besides the footprint, with the rows of all runs."""
        return load(self.folder, table=name)

    def publish(self, table: Table, name: str, columns: Sequence[str], **more: Any) -> None:
        """Write a table as Markdown, CSV and LaTeX, each with its provenance, and print it."""
        for ending in (".md", ".csv", ".tex"):
            path = self.place(f"{name}{ending}")
            table.write(path)
            self.record(path, columns, caption=table.caption, **more)
        print(table.markdown())

    def place(self, name: str) -> Path:
        """Return the path of a published file."""
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
    """Return a parser with the options that all studies share.

    Parameters
    ----------
    design
        Name of the shipped design that the study uses by default.
    reference
        Layout of RAWSim-O on which the study can be run instead of the shipped layout of the same
        size: a path in the folder of RAWSim-O's public instances.
    """
    made = argparse.ArgumentParser(description=(description or "").splitlines()[0])
    made.add_argument("--design", default=design, help=f"another design file (default: {design})")
    made.add_argument("--out", type=Path, help="folder of the runs (default: results/NAME)")
    made.add_argument(
        "--published", type=Path, default=PUBLISHED, help=f"folder of tables (default: {PUBLISHED})"
    )
    made.add_argument(
        "--jobs", type=int, help="maximum number of parallel runs (default: one per core)"
    )
    made.add_argument("--dask", metavar="ADDRESS", help="a Dask scheduler or cluster profile")
    made.add_argument(
        "--replications",
        type=int,
        metavar="N",
        help="use only the first N seeds; more can be added later",
    )
    made.add_argument(
        "--smoke",
        action="store_true",
        help="use two seeds and five simulated minutes, to check that everything works",
    )
    if reference is not None:
        made.add_argument(
            "--reference",
            type=Path,
            metavar="DIR",
            help=f"folder of RAWSim-O's public instances: use the layout DIR/{reference}",
        )
        made.set_defaults(reference_layout=reference)
    return made


def done(
    given: argparse.Namespace,
    *,
    layout: str | None = None,
    more: Mapping[str, Any] | None = None,
    part: str = "",
    replications: int | None = None,
    without: Collection[str] = (),
) -> Study:
    """Execute the unfinished runs of a study's design, and return the results.

    Parameters
    ----------
    given
        Options parsed with a parser that `parser` returned.
    layout
        Layout to use instead of the design's; ignored if the option `--reference` is given.
    more
        Additional entries of the design's table `base`.
    part
        Name of the subfolder for these runs, if the study runs its design several times.
    replications
        Number of seeds to use instead of the design's. If the option `--replications` is given as
        well, the smaller of the two numbers is used.
    without
        Names of arms to leave out.

    Raises
    ------
    InputError
        If the design is invalid, or the folder given by `--reference` lacks the layout.
    SystemExit
        If runs failed, as an incomplete study is not published.
    """
    base, suffix = reference_inputs(given)
    if base is None and layout is not None:
        base = {"layout": layout}
    base = {**(base or {}), **(more or {})}
    if given.smoke:
        suffix += _SMOKE
        made = plan(given.design, base={**base, **SMOKE}, replications=2, without=without)
    else:
        numbers = [n for n in (replications, given.replications) if n is not None]
        first = min(numbers, default=None)
        made = plan(given.design, base=base, replications=first, without=without)
    folder = given.out if given.out is not None else RESULTS / f"{made.design.name}{suffix}"
    folder = folder / part
    with watching(made.design.name) as watcher:
        tally = run(made, folder, processes=given.jobs, dask=given.dask, watcher=watcher)
    if tally.failed:
        print(f"{len(tally.failed)} runs failed: see {folder / 'failures'}", file=sys.stderr)
        raise SystemExit(FAILED)
    given.published.mkdir(parents=True, exist_ok=True)
    return Study(made, load(folder), folder, given.published, suffix)


def station_units_per_h(study: Study) -> float:
    """Return how many units per hour the fastest pick station in the first arm can pick."""
    stations = study.layout(study.plan.arms[0]).pick_stations
    return 3600.0 / min(station.unit_transfer_s for station in stations)


def reference_inputs(given: argparse.Namespace) -> tuple[dict[str, str] | None, str]:
    """Return the inputs that replace those of the design, and the suffix of all file names.

    Without `--reference`, nothing is replaced and the suffix is empty.

    Raises
    ------
    InputError
        If the folder given by `--reference` lacks the layout.
    """
    folder: Path | None = getattr(given, "reference", None)
    if folder is None:
        return None, ""
    layout = folder / given.reference_layout
    if not layout.is_file():
        raise InputError(f"--reference {folder}: {layout} does not exist")
    return {"layout": str(layout.absolute())}, "-reference"


def command(study: Callable[[list[str] | None], None], arguments: list[str] | None = None) -> int:
    """Run a study as a command and return its exit code."""
    try:
        study(arguments)
    except InputError as error:
        print(f"{' '.join(str(error).split())}", file=sys.stderr)
        return WRONG_INPUT
    except KeyboardInterrupt:
        print("interrupted; call again to continue", file=sys.stderr)
        return INTERRUPTED
    return 0
