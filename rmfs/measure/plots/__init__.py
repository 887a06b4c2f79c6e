"""Pictures of runs: one function per picture, each draws into the axes it is given."""

from rmfs.measure.plots.heat import heat as heat
