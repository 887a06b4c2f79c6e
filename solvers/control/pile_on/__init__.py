"""POA and PPS, or POA, PPS and TA, decided together: orders, pods and robots by one model."""

from rmfs.solvers.control.pile_on.controller import PileOnControl as PileOnControl
from rmfs.solvers.control.pile_on.tasks import PileOnTasks as PileOnTasks
