"""Pacing modes and their parameters, parsed from user input."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import pydantic
from pydantic import Field

from rmfs import config
from rmfs.config import Model, Table
from rmfs.errors import InputError
from rmfs.scenario.distributions import Popularity as Distribution
from rmfs.scenario.quantities import NotNegative, Positive
from rmfs.simulation.pacing.planning import InstantPlanning, PlanningSettings, planning_settings


class _Mode(Model):
    model_config = pydantic.ConfigDict(
        extra="forbid", frozen=True, allow_inf_nan=False, use_attribute_docstrings=True
    )
    planning: PlanningSettings = InstantPlanning()
    """Time that path planning takes."""


class InstantPacing(_Mode):
    """Optimisers take no simulated time."""

    mode: Literal["instant"] = "instant"


class WallPacing(_Mode):
    """Optimisers run beside the simulation; their wall time counts as simulated time.

    An optimiser takes `speed` seconds of simulated time per second of wall time.
    """

    mode: Literal["wall"] = "wall"
    speed: Positive = 1.0
    """Simulated seconds per second of wall time while an optimiser is running."""
    workers: Annotated[int, Field(ge=1, le=64)] = 2
    """Number of single-threaded worker processes; if all are busy, questions wait."""
    patience_s: Positive = 300.0
    """Wall time in s after which a worker that has not answered is stopped and replaced."""


class WorkPacing(_Mode):
    """Optimisers take simulated time according to their work.

    The time consists of a constant per call, and of amounts proportional to the solver's work and
    to the number of nonzeros of its model.
    """

    mode: Literal["work"] = "work"
    seconds_per_unit: NotNegative | dict[str, NotNegative] = Field(default_factory=dict)
    """Simulated seconds per unit of work: one number for all back ends, or numbers by name; by
    default as measured on the machine that produced the published figures."""
    seconds_per_call: NotNegative | None = None
    """Additional simulated seconds per call, for all back ends; by default as measured on the
    machine that produced the published figures."""
    seconds_per_entry: NotNegative | None = None
    """Simulated seconds per nonzero entry of the solver's model, for all back ends; by
    default as measured on the machine that produced the published figures."""


class FixedPacing(_Mode):
    """Optimisers take a constant or random simulated time."""

    mode: Literal["fixed"] = "fixed"
    seconds: NotNegative | Distribution = 1.0
    """Simulated seconds per call: a number or a distribution, such as
    `{distribution = "exponential", rate = 0.5}`."""


class ReplayPacing(_Mode):
    """Optimisers are not called; the answers are those of a recorded run."""

    mode: Literal["replay"] = "replay"
    run: Path
    """Folder of the recorded run."""


PacingSettings = InstantPacing | WallPacing | WorkPacing | FixedPacing | ReplayPacing

MODES: dict[str, type[PacingSettings]] = {
    "instant": InstantPacing,
    "wall": WallPacing,
    "work": WorkPacing,
    "fixed": FixedPacing,
    "replay": ReplayPacing,
}

_ARGUMENTS = {"fixed": "seconds", "replay": "run"}
"""The parameter given after the `=` of a mode."""
_EXAMPLES = {"fixed": "SECONDS", "replay": "RUN_DIR"}


def pacing_settings(mode: str, overrides: Sequence[tuple[list[str], Any]] = ()) -> PacingSettings:
    """Parse a pacing mode and its parameters.

    Parameters
    ----------
    mode
        `instant`, `wall`, `work`, `fixed=SECONDS` or `replay=RUN_DIR`.
    overrides
        Pairs of a list of keys and a value, each for one parameter of the mode, such as
        `(["speed"], 2.0)`; if the first key is `planning`, the pair concerns path planning.

    Raises
    ------
    InputError
        If there is no such mode, or a parameter is wrong.
    """
    name, equals, argument = mode.partition("=")
    if name not in MODES:
        near = difflib.get_close_matches(name, MODES, n=1)
        hint = f"did you mean {near[0]}?" if near else f"valid: {', '.join(MODES)}"
        raise InputError(f"pacing {mode}: unknown mode; {hint}")
    table: Table = {"mode": name}
    if equals:
        if name not in _ARGUMENTS:
            raise InputError(f"pacing {mode}: {name} takes no value after =")
        table[_ARGUMENTS[name]] = argument
    own = [(path, value) for path, value in overrides if path[0] != "planning"]
    table = config.apply_overrides(table, own)
    table["planning"] = planning_settings(
        [(path[1:], value) for path, value in overrides if path[0] == "planning"]
    )
    wanted = _ARGUMENTS.get(name, "")
    if wanted and wanted not in table:
        raise InputError(f"pacing {mode}: must have a value, as in {name}={_EXAMPLES[name]}")
    return config.validate(MODES[name], table, f"pacing {name}")
