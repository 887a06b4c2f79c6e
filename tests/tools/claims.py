"""The table of claims: `python -m tests.tools.claims` writes docs/claims.md.

What is claimed is in `claims.toml`, and no number with it: numbers, their intervals and the hashes
of their inputs are read from the published tables and their provenance. A claim also says between
what its interval must lie: a study that was done again and no longer shows it is noticed.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import pandas as pd
from pydantic import Field

from rmfs.config import Model, read_toml, validate
from rmfs.errors import InputError
from rmfs.experiments.provenance import SUFFIX
from rmfs.experiments.tables import HALF, digits
from rmfs.files import write_text

if TYPE_CHECKING:
    from collections.abc import Sequence

SOURCE = Path(__file__).with_name("claims.toml")
PAGE = Path("docs") / "claims.md"
PUBLISHED = Path("results") / "published"

HEAD = """\
# Claims

<!-- written by python -m tests.tools.claims -->

This page lists the numbers that we claim and the commands that reproduce them. The *number* is the
mean over seeds, with the half width of its 95 % confidence interval if there is one; it is read
from the *file*, a table in `results/published`. If a claim compares one thing *against* another,
the number is the first minus the second, or, with the unit %, this difference in percent of the
second. The *input hash* identifies the design: its arms, its seeds and the content of all inputs.
The provenance file beside the table contains the full hash, the runs and the version of the code.

Figures 5a and 5b and section 4 are those of Merschformann, Xie, Li (2018). If a file name contains
`-reference`, the layout is RAWSim-O's own, and `DIR` is a folder with the files of RAWSim-O
([papers](papers.md)). In RAWSim-O, a robot waits for the next time step of the simulation before
every move, lift and set-down. With *RAWSim-O's planner and time steps*, paths are planned by FAR
(flow annotation replanning), and the mean of this wait is added to the times of turning and
lifting. SEQU and M1G are the sequential rules and the joint model of Jiao et al. (2025); *planning
by search* plans several visits of each station ahead ([joint optimisation](joint-optimisation.md)).
*What the stations can do* is the number of units that the pick stations could pick if they never
waited. *Targets* are our own. The [glossary](glossary.md) explains the other terms; *small*,
*default* and *large site* are the shipped layouts of these names.

| claim | number | command | input hash | file |
|---|---|---|---|---|
"""


class ClaimEntry(Model):
    """One claim as it is written down."""

    text: str = Field(description="one sentence; what the number is, with its unit")
    file: str = Field(description="a .csv table in results/published")
    row: str = Field(description="what stands in the first columns, with a comma between them")
    keys: int = Field(1, ge=1, description="how many columns those are")
    column: str = Field(description="name of the column, without its ending `mean`")
    command: str = Field(description="what publishes the file")
    above: float | None = Field(None, description="the whole interval must lie above this")
    below: float | None = Field(None, description="the whole interval must lie below this")


class ClaimFile(Model):
    """The keys of claims.toml."""

    format: Literal["rmfs-claims/1"]
    claims: list[ClaimEntry]


@dataclass(frozen=True)
class Claim:
    """A claim and what has been published for it.

    Attributes
    ----------
    value, half_width
        The number and the half width of its interval; NaN if there is none.
    input_hash
        Of the design that the numbers come from.
    """

    entry: ClaimEntry
    value: float
    half_width: float
    input_hash: str

    @property
    def holds(self) -> bool:
        """Whether the interval lies where the claim says."""
        half = 0.0 if math.isnan(self.half_width) else self.half_width
        low, high = self.value - half, self.value + half
        above = -math.inf if self.entry.above is None else self.entry.above
        below = math.inf if self.entry.below is None else self.entry.below
        return above <= low and high <= below and not math.isnan(self.value)

    @property
    def number(self) -> str:
        """The number as it is shown: as many digits as the interval is worth."""
        shown = digits(pd.Series([self.half_width]), pd.Series([self.value]))
        number = f"{self.value:,.{shown}f}"
        return number if math.isnan(self.half_width) else f"{number} ± {self.half_width:,.{shown}f}"

    def line(self) -> str:
        """Return the claim as a row of the table."""
        entry = self.entry
        cells = (entry.text, self.number, f"`{entry.command}`", f"`{self.input_hash[:12]}`",
                 f"`{entry.file}`")  # fmt: skip
        return "| " + " | ".join(cells) + " |"


def claims(published: Path, source: Path = SOURCE) -> list[Claim]:
    """Return all claims with the numbers that are published.

    Parameters
    ----------
    published
        The folder of published tables.
    source
        What is claimed. Default: the project's own.

    Raises
    ------
    InputError
        If a table, its provenance, a row or a column is missing.
    """
    entries = validate(ClaimFile, read_toml(source), str(source)).claims
    return [_found(entry, published) for entry in entries]


def _found(entry: ClaimEntry, published: Path) -> Claim:
    path = published / entry.file
    try:
        table = pd.read_csv(path)
        names = table.iloc[:, : entry.keys].astype(str).agg(", ".join, axis=1)
        table = table.iloc[:, entry.keys :].set_index(names)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read ({error})") from None
    endings = [f"{entry.column}{ending}" for ending in (" mean", " difference", "")]
    chosen = next((name for name in endings if name in table), entry.column)
    for name, known in ((entry.row, table.index), (chosen, table.columns)):
        if list(known).count(name) != 1:
            there = ", ".join(str(one) for one in known)
            raise InputError(f"{path}: {name}: is not there once; there are {there}")
    half = f"{entry.column} {HALF}"
    value, half_width = (
        float(table[name][entry.row]) if name in table else math.nan for name in (chosen, half)
    )
    return Claim(entry, value, half_width, str(_provenance(path)["design_hash"]))


def _provenance(path: Path) -> dict[str, Any]:
    beside = path.with_name(path.name + SUFFIX)
    try:
        told = json.loads(beside.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{beside}: cannot be read ({error})") from None
    if not isinstance(told, dict) or "design_hash" not in told:
        raise InputError(f"{beside}: holds no design_hash")
    return told


def page(found: Sequence[Claim]) -> str:
    """Return the page of the documentation.

    Raises
    ------
    InputError
        If a claim does not hold: it is not to be published.
    """
    broken = [claim for claim in found if not claim.holds]
    if broken:
        told = "; ".join(f"{claim.entry.text}: {claim.number}" for claim in broken)
        raise InputError(f"no longer shown by what is published: {told}")
    return HEAD + "".join(f"{claim.line()}\n" for claim in found)


def main(arguments: list[str] | None = None) -> int:
    """Write the page."""
    parser = argparse.ArgumentParser(prog="python -m tests.tools.claims")
    parser.add_argument("--published", type=Path, default=PUBLISHED, help="folder of tables")
    parser.add_argument("--page", type=Path, default=PAGE, help=f"file to write (default: {PAGE})")
    given = parser.parse_args(arguments)
    try:
        write_text(given.page, page(claims(given.published)))
    except InputError as error:
        print(f"claims: {error}", file=sys.stderr)
        return 2
    print(given.page)
    return 0


if __name__ == "__main__":
    sys.exit(main())
