"""Modes of path planning, which determine the simulated time needed to compute a plan."""

from __future__ import annotations

import difflib
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import pydantic

from rmfs import config
from rmfs.config import Model
from rmfs.errors import InputError
from rmfs.scenario.quantities import NotNegative, Positive

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rmfs.traffic import Traffic

    Overrides = Sequence[tuple[list[str], Any]]
    Reader = Callable[[Path], tuple[config.Table, "Tape"]]

Tape = list[tuple[int, int, int, int]]
"""Robot, start (us), labels and time taken (us) of each search of a run."""

SECONDS_PER_LABEL = 2.07e-6
"""Seconds per label of a search, as measured by `python -m tests.tools.calibrate_planning` on an
AMD EPYC on 2026-11-23 (results/published/seconds-per-label.md)."""

SECONDS_PER_SEARCH = 3.36e-6
"""Additional seconds per search, from the same measurement."""


class _Planning(Model):
    model_config = pydantic.ConfigDict(
        extra="forbid", frozen=True, allow_inf_nan=False, use_attribute_docstrings=True
    )
    planners: Literal["one", "each"] = "one"
    """`one`: one planner serves all robots, first come, first served. `each`: every robot has a
    planner of its own."""
    period_s: NotNegative = 0.0
    """Plans are begun only at multiples of this time, for robots with a pod first, then in the
    order of requests; 0: whenever a robot asks."""
    lazy: bool = False
    """Whether a robot asks for a plan only when it could depart, not while it is lifting a pod."""


class InstantPlanning(_Planning):
    """Computing a plan takes no simulated time."""

    mode: Literal["instant"] = "instant"


class FixedPlanning(_Planning):
    """Computing a plan takes a constant simulated time."""

    mode: Literal["fixed"] = "fixed"
    seconds: NotNegative
    """Simulated seconds per plan."""


class WorkPlanning(_Planning):
    """Computing a plan takes a constant simulated time per search, and another per label."""

    mode: Literal["work"] = "work"
    seconds_per_label: NotNegative = SECONDS_PER_LABEL
    """Simulated seconds per label; by default as measured on the machine that produced the
    published figures."""
    seconds_per_search: NotNegative = SECONDS_PER_SEARCH
    """Additional simulated seconds per search; by default as measured on the machine that produced
    the published figures."""


class WallPlanning(_Planning):
    """Computing a plan takes `speed` seconds of simulated time per second of wall time."""

    mode: Literal["wall"] = "wall"
    speed: Positive = 1.0
    """Simulated seconds per second of wall time."""


class ReplayPlanning(Model):
    """Computing plans takes the times recorded in a run, whose planning parameters also apply."""

    model_config = _Planning.model_config
    mode: Literal["replay"] = "replay"
    run: Path
    """Folder of the recorded run."""


_Own = InstantPlanning | FixedPlanning | WorkPlanning | WallPlanning
PlanningSettings = InstantPlanning | FixedPlanning | WorkPlanning | WallPlanning | ReplayPlanning

MODES: dict[str, type[PlanningSettings]] = {
    "instant": InstantPlanning,
    "fixed": FixedPlanning,
    "work": WorkPlanning,
    "wall": WallPlanning,
    "replay": ReplayPlanning,
}

_ARGUMENTS = {"fixed": "seconds", "replay": "run"}
"""The parameter given after the `=` of a mode."""
_EXAMPLES = {"fixed": "SECONDS", "replay": "RUN_DIR"}


def planning_settings(overrides: Overrides) -> PlanningSettings:
    """Parse the settings that determine how much simulated time path planning takes.

    Parameters
    ----------
    overrides
        Pairs of a list of keys and a value. If the list is empty or `["mode"]`, the value is the
        mode, such as `fixed=0.3`; otherwise the list names a parameter, as in `(["period_s"], 5)`.

    Raises
    ------
    InputError
        If there is no such mode, or a parameter is wrong.
    """
    mode: Any = "instant"
    given: list[tuple[list[str], Any]] = []
    for path, value in overrides:
        if path in ([], ["mode"]):
            mode = value
        else:
            given.append((path, value))
    name, equals, argument = mode.partition("=") if isinstance(mode, str) else (mode, "", "")
    if name not in MODES:
        near = difflib.get_close_matches(str(name), MODES, n=1)
        hint = f"did you mean {near[0]}?" if near else f"valid: {', '.join(MODES)}"
        raise InputError(f"pacing.planning: {mode}: no such mode; {hint}")
    table: dict[str, Any] = {"mode": name}
    if equals:
        if name not in _ARGUMENTS:
            raise InputError(f"pacing.planning: {mode}: {name} takes no value after =")
        table[_ARGUMENTS[name]] = argument
    table = config.apply_overrides(table, given)
    wanted = _ARGUMENTS.get(name, "")
    if wanted and wanted not in table:
        raise InputError(
            f"pacing.planning: {mode}: must have a value, as in {name}={_EXAMPLES[name]}"
        )
    return config.validate(MODES[name], table, "pacing.planning")


def let_plans_take_time(
    traffic: Traffic, settings: PlanningSettings, planner: str, read: Reader
) -> None:
    """Let the path planning of a fleet take simulated time; the fleet must not have moved yet.

    Parameters
    ----------
    planner
        Name of the fleet's path planner.
    read
        Function that takes the folder of a recorded run, and returns the planning parameters and
        the searches recorded there.

    Raises
    ------
    InputError
        If the planner does not plan one trip at a time, or if planning took no simulated time in
        the run to be replayed.
    """
    tape: Tape = []
    how = settings
    if isinstance(how, ReplayPlanning):
        how, tape = _recorded(how.run, read)
    if isinstance(how, InstantPlanning) and not how.period_s and not how.lazy:
        return
    if planner != "time-windows":
        raise InputError(
            f"pacing.planning: {settings.mode}: not possible with the rolling path planner "
            f"{planner}; valid: controllers.pp.name=time-windows"
        )
    numbers = (0.0, 0.0)
    match how:
        case FixedPlanning():
            numbers = (how.seconds * 1e6, 0.0)
        case WorkPlanning():
            numbers = (how.seconds_per_search * 1e6, how.seconds_per_label * 1e6)
        case WallPlanning():
            numbers = (how.speed, 0.0)
    price = "fixed" if how.mode == "instant" else how.mode
    traffic.set_pace(
        "replay" if tape else price,
        numbers,
        tape=tape,
        period_us=round(how.period_s * 1e6),
        lazy=how.lazy,
        each=how.planners == "each",
    )


def _recorded(run: Path, read: Reader) -> tuple[_Own, Tape]:
    """Return how plans took time in a run, and its searches."""
    kept, tape = read(run)
    if not tape:
        raise InputError(f"pacing.planning: replay: {run}: plans took no time in that run")
    how = config.validate(MODES[kept["mode"]], kept, str(run))
    if isinstance(how, ReplayPlanning):
        return _recorded(how.run, read)
    # constant times are known without a tape
    return how, [] if isinstance(how, InstantPlanning | FixedPlanning) else tape
