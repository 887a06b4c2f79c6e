"""Statistics of simulation experiments, on top of scipy and statsmodels.

Every function takes plain numbers or a frame returned by `experiments.load`.
"""

from rmfs.experiments.statistics.anova import anova as anova
from rmfs.experiments.statistics.anova import tell_apart as tell_apart
from rmfs.experiments.statistics.intervals import Interval as Interval
from rmfs.experiments.statistics.intervals import interval as interval
from rmfs.experiments.statistics.intervals import per_arm as per_arm
from rmfs.experiments.statistics.paired import against as against
from rmfs.experiments.statistics.paired import paired as paired
from rmfs.experiments.statistics.paired import unpaired as unpaired
from rmfs.experiments.statistics.selection import Selection as Selection
from rmfs.experiments.statistics.selection import kim_nelson as kim_nelson
from rmfs.experiments.statistics.sequential import narrow_enough as narrow_enough
from rmfs.experiments.statistics.windows import rates as rates
