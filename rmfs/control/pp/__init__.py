"""Path planning (PP): selection of a planner that runs in the traffic core or in Python."""

from __future__ import annotations

from abc import abstractmethod
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar, cast

import numpy as np
import pydantic

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem
from rmfs.traffic import PlannerSettings
from rmfs.traffic.guidance import read_guidance

if TYPE_CHECKING:
    from collections.abc import Generator

    from rmfs.control.choices import Choice
    from rmfs.control.view import View
    from rmfs.layout.model import Layout
    from rmfs.traffic.planner import Agent, Question, Way

P = TypeVar("P", bound=Parameters)


class PathPlanning(Controller[P]):
    """Selects a planner of the traffic core and passes the controller's parameters to it.

    Attributes
    ----------
    planner
        Name of the planner in the core.
    """

    problem = Problem.PP
    planner: ClassVar[str]


class RollingParameters(Parameters):
    """Parameters of rolling planners, which repeatedly plan paths for all driving robots."""

    period_s: float = pydantic.Field(1.0, gt=0)
    """Minimum simulated time, in seconds, between two calls of the planner."""
    runs_granted: int = pydantic.Field(4, ge=1)
    """Maximum number of straight runs of a robot's planned path that are reserved for the robot at
    a time."""
    patience_s: float = pydantic.Field(30.0, ge=0)
    """Time, in seconds, for which a robot must stand still before it moves to a random free
    waypoint next to it, to resolve a deadlock."""


class PathPlanningInPython(PathPlanning[P]):
    """Base class of planners written in Python; such a planner does not see orders or stock."""

    planner = "python"

    @abstractmethod
    def plan(self, now_us: int, agents: list[Agent]) -> Generator[Question, Any, list[Way | None]]:
        """Plan paths for all driving robots; see `rmfs.traffic.planner.PathPlanner`."""


def planner_settings(choice: Choice, seed: int, layout: Layout | None = None) -> PlannerSettings:
    """Convert the controller chosen for PP into settings of the traffic core.

    Parameters
    ----------
    choice
        The controller and its parameters.
    seed
        Seed of the planner's random decisions, such as where a robot moves to resolve a deadlock.
    layout
        The layout; needed only if the parameter `guidance` names a file.

    Raises
    ------
    InputError
        If the guidance file is invalid or belongs to another layout.
    """
    controller = choice.controller
    assert issubclass(controller, PathPlanning)
    if issubclass(controller, PathPlanningInPython):
        parameters = choice.parameters
        rhythm = {key: float(getattr(parameters, key)) for key in ("period_s", "runs_granted")}
        code = controller(parameters, cast("View", None), np.random.default_rng(seed))
        return PlannerSettings(controller.planner, rhythm, seed, code)
    given = choice.parameters.model_dump()
    file = given.pop("guidance", None)
    numbers = {key: float(value) for key, value in given.items()}
    settings = PlannerSettings(controller.planner, numbers, seed)
    if file is None:
        return settings
    assert layout is not None, "guidance belongs to a layout"
    return settings._replace(guidance=read_guidance(Path(file), layout))
