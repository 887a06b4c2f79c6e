"""Joint decisions of POA and PPS, or POA, PPS and TA: orders, pods and robots in one model."""

from rmfs.solvers.control.pile_on.controller import PileOnControl as PileOnControl
from rmfs.solvers.control.pile_on.tasks import PileOnTasks as PileOnTasks
