"""Plots of runs: one function per plot, each drawing into given axes."""

from rmfs.measure.plots.backlog import backlog as backlog
from rmfs.measure.plots.delays import delays as delays
from rmfs.measure.plots.heat import heat as heat
from rmfs.measure.plots.pile_on import pile_on as pile_on
from rmfs.measure.plots.progression import progression as progression
from rmfs.measure.plots.robots import robots as robots
from rmfs.measure.plots.stations import stations as stations
from rmfs.measure.plots.turnover import turnover as turnover
from rmfs.measure.plots.warmup import warmup as warmup
