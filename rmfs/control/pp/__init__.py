"""Path planning (PP): solved inside traffic; here are only its name and parameters."""

from __future__ import annotations

from typing import TypeVar

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem

P = TypeVar("P", bound=Parameters)


class PathPlanning(Controller[P]):
    """Names a planner of the traffic core; its parameters are passed on."""

    problem = Problem.PP
