"""Plans: the arms of a design with their digests, the hashes of its input files, and errors."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs import config
from rmfs.errors import InputError
from rmfs.experiments.design import file as design_file
from rmfs.experiments.design.arms import PARTS, Arm, arms, factor_names
from rmfs.experiments.design.file import DesignFile
from rmfs.experiments.design.resolve import Resolver
from rmfs.experiments.running.job import Job
from rmfs.files import write_text
from rmfs.measure.registry import columns_of, described

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping

    from rmfs.config import Table

FORMAT = "rmfs-plan/1"
FILE = "plan.json"


class PlanError(InputError):
    """A plan has errors and cannot be run.

    Parameters
    ----------
    problems
        Messages of all errors found.
    """

    def __init__(self, source: str, problems: list[str]) -> None:
        self.source = source
        self.problems = problems
        super().__init__(f"{source}: {'; '.join(problems)}")


@dataclass(frozen=True)
class Plan:
    """A design, its arms with their digests, and the hashes of its input files.

    Attributes
    ----------
    table
        The contents of the design file, changed by the arguments `base` and `replications` of
        `plan`.
    arms
        Arms in the order of the design.
    files
        Hash of every input file, by the file's name.
    problems
        Errors in the design's arms and inputs; a plan with errors cannot be run.
    measures
        The user's measures, as described by `rmfs.measure.registry.described`.
    source
        The file from which the design was read, or another description of its origin.
    """

    design: DesignFile
    table: Table
    arms: list[Arm]
    files: dict[str, str]
    problems: list[str] = field(default_factory=list)
    source: str = ""
    measures: list[dict[str, Any]] = field(default_factory=list)

    @cached_property
    def hash(self) -> str:
        """Hash of the design's contents, its input files and the digests of its arms."""
        told = {"design": self.table, "files": self.files, "arms": [a.digest for a in self.arms]}
        text = json.dumps(told, sort_keys=True, separators=(",", ":"), default=str)
        return hashlib.sha256(text.encode()).hexdigest()

    @property
    def factors(self) -> list[str]:
        """Keys of the factors, in order."""
        return list(self.arms[0].levels) if self.arms else []

    @property
    def short_names(self) -> dict[str, str]:
        """Short names of the factors, by their keys."""
        return factor_names(self.factors)

    def arm(self, name: str) -> Arm:
        """Return the arm with the given name.

        Raises
        ------
        InputError
            If there is no such arm.
        """
        for arm in self.arms:
            if arm.name == name:
                return arm
        shown = ", ".join(arm.name for arm in self.arms[:10])
        more = ", ..." if len(self.arms) > 10 else ""
        raise InputError(f"{name}: no such arm; arms: {shown}{more}")

    def seed(self, arm: Arm, replication: int) -> int:
        """Return the seed of a run.

        With common random numbers, the seed is `replication`. Otherwise, it is derived from
        `replication` and the digest of the arm.
        """
        if self.design.common_random_numbers:
            return replication
        entropy = [replication, int(arm.digest[:16], 16)]
        return int(np.random.SeedSequence(entropy).generate_state(1, np.uint32)[0])

    def job(self, arm: Arm, replication: int) -> Job:
        """Return everything that a worker needs for one run."""
        seed = self.seed(arm, replication)
        seeded = [(key.split("."), seed) for key in self.design.seeded]
        return Job(
            design=self.design.name,
            design_hash=self.hash,
            arm=arm.name,
            arm_digest=arm.digest,
            replication=replication,
            seed=seed,
            inputs={part: _absolute(given) for part, given in arm.inputs.items()},
            overrides=[*arm.overrides, *seeded],
            pacing=arm.pacing,
            check=self.design.check,
            allow_not_well_formed=self.design.allow_not_well_formed,
            keep=tuple(self.design.keep),
            files=self.files,
            measures=tuple(one["reference"] for one in self.measures),
            decisions=_absolute_folder(self.design.decisions),
        )

    def require_sound(self) -> None:
        """Raise an error if the plan cannot be run.

        Raises
        ------
        PlanError
            If `problems` is not empty; the error lists all of them.
        """
        if self.problems:
            raise PlanError(self.source, self.problems)

    def save(self, folder: Path) -> None:
        """Write the plan, which is needed to read results, to the folder of the results."""
        told = {
            "format": FORMAT,
            "hash": self.hash,
            "source": self.source,
            "design": self.table,
            "files": self.files,
            "measures": self.measures,
            "arms": [asdict(arm) for arm in self.arms],
        }
        write_text(folder / FILE, json.dumps(told, indent=1, ensure_ascii=False, default=str))


def plan(
    name_or_path: str | Path,
    *,
    base: Mapping[str, Any] | None = None,
    replications: int | None = None,
    without: Collection[str] = (),
    told: Callable[[int, int], None] | None = None,
) -> Plan:
    """Read a design, read the inputs of all its arms, and compute the digests of the arms.

    Parameters
    ----------
    name_or_path
        A design file, or the name of a shipped one.
    base
        Entries to add to the design's table `base`, or to replace in it.
    replications
        Number of seeds to use instead of the design's number; only for designs without stages. If
        the design lists its seeds, the first ones of the list are used.
    without
        Names of arms to leave out.
    told
        Function called before each arm, with the number of finished arms and the number of all
        arms.

    Raises
    ------
    InputError
        If the design file is missing or invalid. Errors in arms are listed in `Plan.problems`.
    """
    path = design_file.locate(name_or_path)
    _, table = design_file.read(path)
    if replications is not None and table.get("stages"):
        raise InputError(f"{path}: stages: state their own seeds; replications cannot be set")
    if base or replications is not None:
        table = {**table, "base": {**table["base"], **(base or {})}}
        seeds = table.get("seeds")
        if replications is not None and isinstance(seeds, list):
            if not 1 <= replications <= len(seeds):
                raise InputError(f"{path}: lists {len(seeds)} seeds; not {replications}")
            table["seeds"] = seeds[:replications]
        elif replications is not None:
            table["replications"] = replications
    return plan_of(table, path.parent, str(path), without=without, told=told)


def plan_of(
    table: Table,
    folder: Path,
    source: str,
    *,
    without: Collection[str] = (),
    told: Callable[[int, int], None] | None = None,
) -> Plan:
    """Return the plan of a design that is given as a table, not as a file; see `plan`.

    Parameters
    ----------
    table
        The contents of a design file.
    folder
        Folder that is searched first for files.
    source
        Origin of the design, for error messages.
    """
    measures = design_file.own_measures(table, folder)
    design = config.validate(DesignFile, table, source)
    made, problems = arms(design, folder)
    problems += [] if problems else _too_many_chosen(design, len(made))
    made = [arm for arm in made if arm.name not in without]
    if any(problem.startswith("base: ") for problem in problems):
        return Plan(design, table, made, {}, problems, source)
    resolver = Resolver(design.allow_not_well_formed, measures)
    resolved: list[Arm] = []
    wrong: dict[str, list[str]] = {}
    for count, arm in enumerate(made):
        if told is not None:
            told(count, len(made))
        digest, found = resolver.digest(arm, check=design.check, seeded=design.seeded)
        resolved.append(replace(arm, digest=digest))
        for problem in found:
            wrong.setdefault(problem, []).append(arm.name)
    problems += [f"{_named(names)}: {problem}" for problem, names in wrong.items()]
    problems += [] if wrong else _twins(resolved)
    files = dict(sorted(resolver.files.items()))
    return Plan(design, table, resolved, files, problems, source, described(measures))


def load(folder: Path) -> Plan:
    """Load the plan from a folder of results.

    Raises
    ------
    InputError
        If there is no plan, or it is corrupted.
    """
    path = folder / FILE
    try:
        told = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise InputError(f"{folder}: contains no experiment ({FILE} is missing)") from None
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read ({error})") from None
    if not isinstance(told, dict) or told.get("format") != FORMAT:
        raise InputError(f"{path}: expected format {FORMAT!r}")
    try:
        measures = told.get("measures", [])
        columns_of(measures)
        design = config.validate(DesignFile, told["design"], str(path))
        made = [_arm(arm) for arm in told["arms"]]
        return Plan(
            design, told["design"], made, told["files"], source=told["source"], measures=measures
        )
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(f"{path}: corrupted ({error!r})") from None


def _arm(told: dict[str, Any]) -> Arm:
    """Return an arm that was read from a saved plan.

    Raises
    ------
    KeyError, TypeError, ValueError
        If the table does not describe an arm.
    """
    overrides = [(list(keys), value) for keys, value in told["overrides"]]
    arm = Arm(**(told | {"overrides": overrides}))
    words = [arm.name, arm.pacing, arm.digest, *(arm.inputs[part] for part in PARTS)]
    words += [key for keys, _ in overrides for key in keys]
    if wrong := [word for word in words if not isinstance(word, str)]:
        raise TypeError(f"expected a text, not {wrong[0]!r}")
    for level in told["levels"].values() if isinstance(told["levels"], dict) else [[]]:
        if not isinstance(level, str | int | float | None):
            raise TypeError(f"expected a level, not {level!r}")
    return arm


def _absolute_folder(given: str) -> str:
    """Return the absolute path of a folder, for workers in other folders; empty stays empty."""
    return str(Path(given).absolute()) if given else ""


def _absolute(given: str) -> str:
    """Return the absolute path of a file; names of shipped inputs remain unchanged."""
    return str(Path(given).absolute()) if Path(given).is_file() else given


def _named(names: list[str]) -> str:
    if len(names) == 1:
        return f"arm {names[0]}"
    shown = " | ".join(names[:3])
    return f"arms {shown}" + (f" and {len(names) - 3} more" if len(names) > 3 else "")


def _too_many_chosen(design: DesignFile, arms: int) -> list[str]:
    """Return an error for each stage that is to choose more arms than the stage before has."""
    problems = []
    for stage in design.stages:
        if stage.arms is None:
            continue
        if stage.arms.best > arms:
            problems.append(
                f"stage {stage.name}: arms.best = {stage.arms.best}: must be from 1 to {arms}, the "
                "number of arms in the stage before"
            )
        arms = min(stage.arms.best, arms)
    return problems


def _twins(made: list[Arm]) -> list[str]:
    """Return an error for all arms with the same digest: their runs would count twice."""
    groups: dict[str, list[str]] = {}
    for arm in made:
        groups.setdefault(arm.digest, []).append(arm.name)
    return [f"{_named(names)}: are the same" for names in groups.values() if len(names) > 1]
