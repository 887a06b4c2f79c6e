"""Path planning (PP): solved inside traffic; here are the names and parameters of its planners."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, TypeVar

import pydantic

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem
from rmfs.traffic import PlannerSettings

if TYPE_CHECKING:
    from rmfs.control.choices import Choice

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
    """Straight runs of its plan that a robot may be granted at once; RAWSim-O: 1."""
    patience_s: float = pydantic.Field(30.0, ge=0)
    """How long a robot stands still before it hops to a random neighbour."""


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
    numbers = {key: float(value) for key, value in choice.parameters.model_dump().items()}
    return PlannerSettings(controller.planner, numbers, seed)
