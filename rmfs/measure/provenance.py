"""The contents of `run.json`: inputs and parameters of a run, versions, and the machine."""

from __future__ import annotations

import datetime
import hashlib
import os
import platform
import subprocess
from dataclasses import asdict
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs import foreign, instances
from rmfs.config import apply_overrides, read_toml, validate
from rmfs.control.files import named_files as files_of_controllers
from rmfs.digest import digest
from rmfs.errors import InputError
from rmfs.layout.loading import split_factors
from rmfs.layout.parameters import LayoutParameters
from rmfs.measure.measures import SHIPPED
from rmfs.measure.registry import described
from rmfs.scenario import named_files
from rmfs.sources import sources

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rmfs.control.choices import Choice
    from rmfs.layout.model import Layout
    from rmfs.measure.base import Measure
    from rmfs.measure.checker import CheckReport
    from rmfs.measure.ended import Measured, Recorded

PACKAGES = (
    "clarabel",
    "cvxpy",
    "highspy",
    "jinja2",
    "matplotlib",
    "networkx",
    "numpy",
    "ortools",
    "pandas",
    "pyarrow",
    "pydantic",
    "rich",
    "scipy",
    "typer",
)
"""Packages whose version is recorded: all dependencies, including solvers."""

KINDS: dict[str, instances.Kind] = {
    "layout": "layouts",
    "scenario": "scenarios",
    "controllers": "controllers",
}


def marks(interventions: Iterable[tuple[float, Choice]]) -> str:
    """Return what is appended to the name of a set of controllers for exchanges during a run."""
    return "".join(
        f"+{choice.problem}={choice.name}@{time_s:.6f}s" for time_s, choice in interventions
    )


def describe(
    run: Recorded, report: CheckReport | None = None, inputs: Mapping[str, str] | None = None
) -> dict[str, Any]:
    """Return everything needed to identify and repeat the run.

    Parameters
    ----------
    report
        Result of the trace checker, if it ran.
    inputs
        Layout, scenario and controllers as specified by the user (names or paths). Default: the
        names in `run`.
    """
    table = run.controllers.to_table()
    *names, controllers = run.names
    names.append(controllers.removesuffix(marks(run.interventions)))
    given = dict(zip(KINDS, names, strict=True)) if inputs is None else dict(inputs)
    return {
        "layout": {
            **source("layout", given["layout"]),
            "digest": digest(run.layout),
            "size": _size(run.layout),
            "sources": _sources(type(kind) for kind in run.layout.other_kinds),
            "parameters": layout_parameters(given["layout"], run.overrides),
        },
        "scenario": {
            **source("scenario", given["scenario"]),
            "files": {key: _hash(path) for key, path in named_files(run.scenario).items()},
            "parameters": run.scenario.model_dump(mode="json"),
        },
        "controllers": {
            **source("controllers", given["controllers"]),
            "files": {key: _hash(path) for key, path in files_of_controllers(table).items()},
            "parameters": table,
            "sources": _sources(run.controllers.rules()),
        },
        "interventions": [
            {"time_s": time_s, "problem": str(choice.problem), "rule": choice.to_table()}
            for time_s, choice in run.interventions
        ],
        "measures": described(own_measures(run)),
        "overrides": {".".join(path): value for path, value in run.overrides},
        "notes": run.notes,
        "slow_robots": run.slow_robots,
        "seed": run.seed,
        "pacing": run.pacing,
        "pacing_parameters": run.pacing_settings.model_dump(mode="json"),
        "warmup_s": run.warmup_s,
        "duration_s": run.duration_s,
        "check": None
        if report is None
        else {"findings": len(report.findings), "collisions": report.collisions},
        "rmfs": {"version": version(), **commit()},
        "packages": {name: metadata.version(name) for name in PACKAGES},
        "machine": machine(),
        "written": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
    }


def _sources(classes: Iterable[type]) -> dict[str, Any]:
    """Return the user's source files that classes depend on, and their hashes."""
    found = sources(classes).items()
    return {module: {"file": str(path), "sha256": _hash(path)} for module, path in found}


def own_measures(run: Measured) -> list[type[Measure]]:
    """Return the classes of the measures that the user added to a run."""
    return [type(measure) for measure in run.measures if type(measure) not in SHIPPED]


def source(part: str, given: str) -> dict[str, Any]:
    """Return name, file and SHA-256 of an input.

    Parameters
    ----------
    part
        Kind of the input: `layout`, `scenario` or `controllers`.
    given
        Name or path of the input. If no such file is found, `given` is returned as the name, and
        file and SHA-256 are None.
    """
    try:
        path = instances.locate(KINDS[part], given)
        content = _hash(path)
    except (InputError, OSError):
        return {"name": given, "file": None, "sha256": None}
    shipped = path.is_relative_to(instances.ROOT)
    told = Path("instances") / path.relative_to(instances.ROOT) if shipped else path
    return {
        "name": path.stem,
        "file": told.as_posix(),
        "sha256": content,
    }


def _hash(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def layout_parameters(
    given: str, overrides: Sequence[tuple[list[str], Any]]
) -> dict[str, Any] | None:
    """Return all parameters from which a layout was generated, including overrides and defaults.

    Returns
    -------
    dict or None
        The parameters; None for a layout that was not generated from parameters or was given as a
        Python object. `run.json` identifies such a layout by its digest.

    Raises
    ------
    InputError
        If the layout file cannot be read, or its parameters are invalid.
    """
    try:
        path = instances.locate("layouts", given)
    except InputError:
        return None
    if path.suffix == ".toml":
        table = read_toml(path)
    elif path.suffix == ".xlayo":
        table, _ = foreign.read(path)
    else:
        return None
    own, _ = split_factors([(keys[1:], value) for keys, value in overrides if keys[0] == "layout"])
    parameters = validate(LayoutParameters, apply_overrides(table, own), str(path))
    return parameters.model_dump(mode="json")


def _size(layout: Layout) -> dict[str, Any]:
    return {
        "tiers": [asdict(tier) for tier in layout.tiers],
        "waypoints": layout.waypoints,
        "pods": layout.pods,
        "robots": layout.robots,
        "pick_stations": len(layout.pick_stations),
        "replenishment_stations": len(layout.replenishment_stations),
        "elevators": len(layout.elevators),
    }


def version() -> str:
    """Return the installed version of rmfs, or `unknown`."""
    try:
        return metadata.version("rmfs")
    except metadata.PackageNotFoundError:
        return "unknown"


def commit() -> dict[str, Any]:
    """Return the commit of the checkout with this code, and whether the checkout is modified.

    Changes in the folder `results` are ignored, so that publishing a table there does not mark the
    code as modified. If rmfs is installed from a wheel, both values are None, even if the virtual
    environment lies in a repository.
    """
    here = Path(__file__)
    head = _git(here.parent, "rev-parse", "HEAD")
    if head is None or _git(here.parent, "ls-files", "--error-unmatch", here.name) is None:
        return {"git_commit": None, "git_changed": None}
    code = ("--", ":(top)", ":(top,exclude)results")
    changes = _git(here.parent, "status", "--porcelain", "--untracked-files=no", *code)
    return {"git_commit": head, "git_changed": bool(changes)}


def _git(folder: Path, *arguments: str) -> str | None:
    """Return the output of git, or None if it fails."""
    try:
        done = subprocess.run(
            ["git", "-C", str(folder), *arguments],
            capture_output=True,
            text=True,
            timeout=10,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return done.stdout.strip()


def machine() -> dict[str, Any]:
    """Return those properties of this machine that affect wall times and memory."""
    return {
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.release()}",
        "architecture": platform.machine(),
        "processor": _processor(),
        "cores": os.cpu_count(),
    }


def _processor() -> str:
    try:
        told = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    names = [line.partition(":")[2].strip() for line in told if line.startswith("model name")]
    return names[0] if names else platform.processor()
