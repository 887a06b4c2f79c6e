"""The data sent to a worker, and the data it returns."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class Job:
    """One run, with everything needed to execute it on any machine.

    Attributes
    ----------
    arm_digest
        Hash of everything that determines the run except its seed.
    replication
        The seed as listed in the design; `seed` may be derived from it.
    files
        Hash of every input file of the design, checked by the worker.
    measures
        References to user-defined measures (see `rmfs.references`).
    decisions
        Folder in which the questions to optimisers are recorded; "" if they are not recorded.
    """

    design: str
    design_hash: str
    arm: str
    arm_digest: str
    replication: int
    seed: int
    inputs: dict[str, str]
    overrides: list[tuple[list[str], Any]]
    pacing: str
    check: bool
    allow_not_well_formed: bool
    keep: tuple[str, ...]
    files: dict[str, str]
    measures: tuple[str, ...] = ()
    decisions: str = ""

    @property
    def key(self) -> str:
        """Key that identifies the run; runs with the same key have the same results."""
        return run_key(self.arm_digest, self.seed)

    def __str__(self) -> str:
        """Return the name of the run for messages."""
        return f"{self.arm}, seed {self.seed}"


@dataclass(frozen=True)
class Outcome:
    """What a job returns: the results of its run, or the error.

    Attributes
    ----------
    footprint
        The footprint, one row; None if the run failed.
    tables
        The tables to keep besides the footprint, by name.
    error
        Error in one line; empty if there was none.
    traceback
        Traceback of the error.
    died
        Whether the worker died without reporting an error.
    elapsed_s
        Wall time of the job in s, including the time to load the inputs and compute the tables.
    cpu_s
        Processor time of the job in s.
    host
        Name of the machine.
    """

    footprint: pd.DataFrame | None = None
    tables: dict[str, pd.DataFrame] = field(default_factory=dict)
    error: str = ""
    traceback: str = ""
    died: bool = False
    elapsed_s: float = 0.0
    cpu_s: float = 0.0
    host: str = ""


def run_key(arm_digest: str, seed: int) -> str:
    """Return the key that identifies a run."""
    return hashlib.sha256(f"{arm_digest}/{seed}".encode()).hexdigest()[:24]
