"""The table of claims: `python -m tests.tools.claims` writes docs/claims.md.

The texts of the claims are in `claims.toml`. The numbers, their intervals and the hashes of their
inputs are read from the published tables and their provenance. A claim may also state bounds
between which its interval must lie, so that an error is reported if a repeated study no longer
supports the claim.
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

This page lists the numbers that we claim and the commands that reproduce them. Each *number* is
read from the *file* in the last column, a table in `results/published`. Unless the claim states
otherwise, it is a mean over seeds; if the table contains its 95 % confidence interval, the number
is followed by ± and half the width of this interval. If a claim compares one thing *against*
another, the number is the value of the first minus that of the second or, if the unit is %, this
difference in percent of the second. The *input hash* identifies the design: its arms, its seeds and
the content of all inputs. The provenance file beside the table contains the full hash, the runs and
the version of the code.

Figures 5a and 5b and section 4 are those of Merschformann, Xie, Li (2018), the paper on the
simulator RAWSim-O. Section 4 of the paper describes the [demonstrator](demonstrator.md). For figure
5a, the *difference in differences* is the change from the first to the second half of the day in
runs with the switch, minus the change in runs without it. If a file name contains `-reference`, the
layout is RAWSim-O's own, and `DIR` is a folder with the files of RAWSim-O ([papers](papers.md)). In
RAWSim-O, a robot waits for the next time step of the simulation before every straight drive, lift
and set-down. With *RAWSim-O's planner and time steps*, paths are planned by FAR (flow annotation
replanning), and the mean of this wait is added to the times of turning, lifting and setting down.

- *Sites*: the *small*, *default* and *large site* are the shipped layouts of these names.
- *Demand*: with a *backlog*, a constant number of orders waits; with *arrivals*, orders arrive over
  time. *Third hour* means that the first two hours of the run are its warm-up.
- *Controllers*: SEQU and M1G are the sequential rules and the joint model of Jiao et al. (2025).
  *Split orders decided jointly with pods* refers to the controllers `pile-on-split`, and *split
  orders, pods and robots decided by models* to `pile-on-dispatch`. *Planning by search* plans
  several visits of pods to each station ahead ([joint optimisation](joint-optimisation.md)). PPO is
  proximal policy optimisation, a method of reinforcement learning ([learning](learning.md)).
- *Measures*: the *station share* is the number of units picked, as a share of the number that the
  pick stations could pick if they never waited. *Metres per unit* is the distance driven per unit
  picked. *Late orders* are completed late or overdue at the end of the run.
- *Targets* were set by ourselves.

The [glossary](glossary.md) explains the other terms.

| claim | number | command | input hash | file |
|---|---|---|---|---|
"""


class ClaimEntry(Model):
    """One claim, as given in claims.toml."""

    text: str = Field(description="what the number is, with its unit, in one sentence")
    file: str = Field(description="a .csv table in results/published")
    row: str = Field(description="the values in the first columns, separated by `, `")
    keys: int = Field(1, ge=1, description="number of these first columns")
    column: str = Field(description="name of the column, without its ending `mean`")
    command: str = Field(description="command that publishes the file")
    above: float | None = Field(None, description="the whole interval must lie above this")
    below: float | None = Field(None, description="the whole interval must lie below this")


class ClaimFile(Model):
    """The keys of claims.toml."""

    format: Literal["rmfs-claims/1"]
    claims: list[ClaimEntry]


@dataclass(frozen=True)
class Claim:
    """A claim, with its number and the input hash from the published table.

    Attributes
    ----------
    value, half_width
        The number and the half width of its interval; NaN if there is none.
    input_hash
        Hash of the design from which the number was computed.
    """

    entry: ClaimEntry
    value: float
    half_width: float
    input_hash: str

    @property
    def holds(self) -> bool:
        """Whether the interval lies between the bounds of the claim."""
        half = 0.0 if math.isnan(self.half_width) else self.half_width
        low, high = self.value - half, self.value + half
        above = -math.inf if self.entry.above is None else self.entry.above
        below = math.inf if self.entry.below is None else self.entry.below
        return above <= low and high <= below and not math.isnan(self.value)

    @property
    def number(self) -> str:
        """The number as text, rounded according to the width of its interval."""
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
    """Return all claims with their published numbers.

    Parameters
    ----------
    published
        The folder of published tables.
    source
        The file of claims. Default: that of the project.

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
        If the published number of a claim violates its bounds.
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
