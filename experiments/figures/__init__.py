"""Figures: one function per figure, each draws into the axes it is given."""

from experiments.figures.effects import effects as effects
from experiments.figures.intervals import intervals as intervals
from experiments.figures.pareto import front as front
from experiments.figures.pareto import pareto as pareto
from experiments.figures.progression import progression as progression
