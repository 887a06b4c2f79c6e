"""The contents of a design file (`rmfs-design/1`)."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import pydantic
from pydantic import Field

from rmfs import config
from rmfs.config import Model, Table
from rmfs.errors import InputError
from rmfs.measure.base import Measure as Measurement
from rmfs.measure.dictionary import TABLES, better_of, footprint_column
from rmfs.measure.registry import find_all
from rmfs.references import anchored

SHIPPED = Path(__file__).resolve().parent.parent / "designs"
"""The folder of shipped designs."""

Seed = Annotated[int, Field(ge=0)]
Share = Annotated[float, Field(gt=0, lt=1)]
Goal = Literal["max", "min"]


def _measure(name: str) -> str:
    column = footprint_column(name)
    if column is None or not column.is_number:
        raise ValueError("is not a number of the footprint")
    if column.measured:
        raise ValueError("is a measured time: which runs follow would not be reproducible")
    return name


def _goal(column: str, stated: Goal | None) -> Goal:
    """Return the stated goal or, if none is stated, the column's goal in the data dictionary."""
    if stated is not None:
        return stated
    better = better_of(column)
    if better == "neither":
        raise ValueError(
            f"the data dictionary does not say whether more or less {column} is better: add "
            'goal = "max" or "min"'
        )
    return "max" if better == "more" else "min"


Measure = Annotated[str, pydantic.AfterValidator(_measure)]


class Strict(Model):
    """Base class of the tables of a design file: a number must not be written as a string."""

    model_config = pydantic.ConfigDict(strict=True, allow_inf_nan=False)


class Best(Strict):
    """Selection of the arms of a stage: those with the best means in the previous stage.

    The means cover the seeds stated for the previous stage. An arm without a value for each of
    these seeds, for example because a run failed, is left out.
    """

    best: int = Field(ge=1, description="number of arms")
    by: Measure = Field(description="column of the footprint whose means are compared")
    goal: Goal | None = Field(
        None, description="whether to maximise or minimise it; default: from the data dictionary"
    )

    @pydantic.model_validator(mode="after")
    def _known_goal(self) -> Best:
        self.better()
        return self

    def better(self) -> Goal:
        """Return `max` or `min`: whether larger or smaller values of the column are better."""
        return _goal(self.by, self.goal)


class Until(Strict):
    """Sequential stopping: each arm gets seeds until its confidence interval is narrow enough."""

    column: Measure
    relative_half_width: Share = 0.02
    confidence: Share = 0.95
    step: int = Field(1, ge=1, description="seeds added at a time")
    max_seeds: int = Field(50, ge=2, description="maximum number of seeds per arm")


class Select(Strict):
    """Selection of the best arm with limited error probability: procedure KN (Kim, Nelson 2001)."""

    procedure: Literal["kim-nelson"] = "kim-nelson"
    column: Measure
    goal: Goal | None = Field(
        None, description="whether to maximise or minimise it; default: from the data dictionary"
    )
    indifference: float = Field(
        gt=0, description="smallest difference worth detecting, in units of the column"
    )
    error: Share = Field(0.05, description="maximum probability of a wrong choice")
    max_seeds: int = Field(200, ge=2, description="maximum number of seeds per arm")

    @pydantic.model_validator(mode="after")
    def _known_goal(self) -> Select:
        self.better()
        return self

    def better(self) -> Goal:
        """Return `max` or `min`: whether larger or smaller values of the column are better."""
        return _goal(self.column, self.goal)


class Stage(Strict):
    """One of several successive parts of an experiment.

    All arms of a stage get the seeds of the stage; `until` or `select` may then add further seeds.
    """

    name: str = Field(min_length=1)
    seeds: list[Seed] | None = None
    replications: int | None = Field(None, ge=1)
    arms: Best | None = Field(None, description="default: all arms")
    until: Until | None = None
    select: Select | None = None

    @pydantic.model_validator(mode="after")
    def _one_rule(self) -> Stage:
        if self.until is not None and self.select is not None:
            raise ValueError(f"stage {self.name}: until and select cannot be combined")
        return self


class DesignFile(Strict):
    """The keys of a design file."""

    format: Literal["rmfs-design/1"]
    name: str = Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$")
    description: str = ""

    seeds: list[Seed] | None = Field(None, description="seeds of the runs of every arm")
    replications: int | None = Field(
        None, ge=1, description="number of seeds, counted from first_seed; instead of seeds"
    )
    first_seed: Seed = 1
    common_random_numbers: bool = Field(
        True, description="whether the same seed means the same demand for every arm"
    )
    seeded: list[str] = Field(
        [], description='parameters that are set to the seed of the run, for example "layout.seed"'
    )

    pacing: str = Field(
        "instant", description="how simulated time accounts for the computation of optimisers"
    )
    check: bool = Field(False, description="prove every run free of collisions; fills `collisions`")
    allow_not_well_formed: bool = False
    keep: list[str] = Field([], description="tables to keep of every run besides its footprint")
    decisions: str = Field(
        "",
        description="folder for all questions to optimisers, with a subfolder per run",
    )
    measures: list[str] = Field(
        [],
        description="additional measures: path/to/file.py:Class, module:Class, or the name "
        "of an installed one",
    )

    base: Table = Field(
        description="layout, scenario, controllers, and parameters shared by all arms"
    )
    factors: dict[str, list[Any]] = Field({}, description="levels of each factor: a grid of arms")
    arms: list[Table] = Field([], description="single arms, each combined with the grid")
    arms_file: str | None = Field(
        None, description=".csv (one column per parameter) or .toml ([[arms]]) file with more arms"
    )
    exclude: list[Table] = Field([], description="combinations of levels to leave out")
    only_file: str | None = Field(
        None,
        description=".csv file with a column per factor and a row per combination; all other "
        "combinations are left out (a fraction of the grid, see "
        "`rmfs.experiments.design.fraction`)",
    )
    stages: list[Stage] = Field([], description="default: one stage with the seeds above")

    @pydantic.model_validator(mode="after")
    def _consistent(self) -> DesignFile:
        wrong = [
            *_seed_problems("", self.seeds, self.replications, needed=not self.stages),
            *(
                problem
                for stage in self.stages
                for problem in _seed_problems(
                    f"stage {stage.name}: ",
                    stage.seeds,
                    stage.replications,
                    needed=self.seeds is None and self.replications is None,
                )
            ),
            *_stage_problems(self.stages),
            *(
                f"stage {stage.name}: {rule} needs from 2 to max_seeds seeds to begin with"
                for stage in self.stages
                for rule, wanted in (("until", stage.until), ("select", stage.select))
                if wanted is not None and not 2 <= len(self.seeds_of(stage)) <= wanted.max_seeds
            ),
            *(f"factor {key}: has no levels" for key, levels in self.factors.items() if not levels),
            *(
                f"keep: no table {table}; valid: {', '.join(list(TABLES)[1:])}"
                for table in self.keep
                if table not in TABLES or table == "footprint"
            ),
        ]
        if wrong:
            raise ValueError("; ".join(wrong))
        return self

    def seeds_of(self, stage: Stage | None = None) -> list[int]:
        """Return the initial seeds of a stage; if it states none, those of the design."""
        for given in (stage, self):
            if given is not None and given.seeds is not None:
                return given.seeds
            if given is not None and given.replications is not None:
                return list(range(self.first_seed, self.first_seed + given.replications))
        return []

    def all_stages(self) -> list[Stage]:
        """Return the stages; for a design without stages, a single stage with all runs."""
        return self.stages or [Stage(name="all")]


def _seed_problems(
    where: str, seeds: list[int] | None, replications: int | None, *, needed: bool
) -> list[str]:
    if seeds is not None and replications is not None:
        return [f"{where}seeds and replications exclude each other"]
    if seeds is None and replications is None:
        return [f"{where}seeds: missing (a list of seeds, or replications = N)"] if needed else []
    if seeds is not None and (not seeds or len(set(seeds)) < len(seeds)):
        return [f"{where}seeds: must be different, and at least one"]
    return []


def _stage_problems(stages: list[Stage]) -> list[str]:
    names = [stage.name for stage in stages]
    problems = [f"two stages are called {name}" for name in set(names) if names.count(name) > 1]
    if stages and stages[0].arms is not None:
        problems.append(f"stage {names[0]}: arms.best needs a stage before")
    return problems


def locate(name_or_path: str | Path) -> Path:
    """Return the path of a design file, given this path or the name of a shipped design.

    Raises
    ------
    InputError
        If there is no such file and no such shipped design; the message lists the shipped designs.
    """
    path = Path(name_or_path)
    if path.is_file():
        return path
    shipped = SHIPPED / f"{name_or_path}.toml"
    if shipped.is_file():
        return shipped
    known = ", ".join(sorted(file.stem for file in SHIPPED.glob("*.toml")))
    raise InputError(f"{name_or_path}: no such file, and no shipped design; shipped: {known}")


def read(path: Path) -> tuple[DesignFile, Table]:
    """Read a design file.

    Returns
    -------
    The validated design, and the contents of the file as a table.

    Raises
    ------
    InputError
        If the file is invalid; the message lists every error with its key.
    """
    table = config.read_toml(path)
    own_measures(table, path.parent)
    return config.validate(DesignFile, table, str(path)), table


def own_measures(table: Table, folder: Path) -> list[type[Measurement]]:
    """Find the measures that a design names, and register their columns.

    Parameters
    ----------
    folder
        Folder that is searched first for the files of the measures.

    Raises
    ------
    InputError
        If a measure cannot be found.
    """
    given = table.get("measures", [])
    if not isinstance(given, list):  # the validation says so
        return []
    return find_all(
        anchored(one, folder) if isinstance(one, str) else one
        for one in given
        if isinstance(one, str | type)
    )
