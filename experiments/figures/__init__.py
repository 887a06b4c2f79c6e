"""Figures: one function per figure, which draws into the given axes."""

from rmfs.experiments.figures.effects import effects as effects
from rmfs.experiments.figures.interaction import interaction as interaction
from rmfs.experiments.figures.intervals import intervals as intervals
from rmfs.experiments.figures.pareto import front as front
from rmfs.experiments.figures.pareto import pareto as pareto
from rmfs.experiments.figures.progression import progression as progression
