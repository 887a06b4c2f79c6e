"""Method management (MM): exchange of controllers while the system runs."""

from __future__ import annotations

from typing import TypeVar

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem

P = TypeVar("P", bound=Parameters)


class MethodManagement(Controller[P]):
    """Says which controller is to be exchanged for which, and when.

    The world remembers what controllers have promised (bundles on pods, robots on tasks), so that a
    successor carries on where its predecessor stopped.
    """

    problem = Problem.MM
