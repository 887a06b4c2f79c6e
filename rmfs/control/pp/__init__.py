"""Path planning (PP): solved inside traffic; here are the names and parameters of its planners."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar, cast

import numpy as np
import pydantic

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem
from rmfs.traffic import PlannerSettings

if TYPE_CHECKING:
    from collections.abc import Generator

    from rmfs.control.choices import Choice
    from rmfs.control.view import View
    from rmfs.traffic.planner import Agent, Question, Way

P = TypeVar("P", bound=Parameters)


class PathPlanning(Controller[P]):
    """Names a planner of the traffic core; its parameters are passed on.

    Attributes
    ----------
    planner
        Its name in the core.
    """

    problem = Problem.PP
    planner: ClassVar[str]


class RollingParameters(Parameters):
    """What all planners have in common that are asked for all robots again and again."""

    period_s: float = pydantic.Field(1.0, gt=0)
    """Least simulated time between two calls of the planner."""
    runs_granted: int = pydantic.Field(4, ge=1)
    """Straight runs of its plan that a robot may be granted at once."""
    patience_s: float = pydantic.Field(30.0, ge=0)
    """How long a robot stands still before it hops to a random neighbour."""


class PathPlanningInPython(PathPlanning[P]):
    """Base of planners written in Python: they see traffic, and no view of the world."""

    planner = "python"

    @abstractmethod
    def plan(self, now_us: int, agents: list[Agent]) -> Generator[Question, Any, list[Way | None]]:
        """Plan ways for all robots that drive; see `rmfs.traffic.planner.PathPlanner`."""


def planner_settings(choice: Choice, seed: int) -> PlannerSettings:
    """Pass a choice of controller on to the traffic core.

    Parameters
    ----------
    choice
        Of the problem PP.
    seed
        Of the planner's random decisions, such as the hops of robots in a deadlock.
    """
    controller = choice.controller
    assert issubclass(controller, PathPlanning)
    if issubclass(controller, PathPlanningInPython):
        parameters = choice.parameters
        rhythm = {key: float(getattr(parameters, key)) for key in ("period_s", "runs_granted")}
        code = controller(parameters, cast("View", None), np.random.default_rng(seed))
        return PlannerSettings(controller.planner, rhythm, seed, code)
    numbers = {key: float(value) for key, value in choice.parameters.model_dump().items()}
    return PlannerSettings(controller.planner, numbers, seed)
