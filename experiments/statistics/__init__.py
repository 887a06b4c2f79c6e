"""Statistics of simulation experiments, on top of scipy and statsmodels.

Every function takes plain numbers or the frame that `experiments.load` returns.
"""

from experiments.statistics.anova import anova as anova
from experiments.statistics.intervals import Interval as Interval
from experiments.statistics.intervals import interval as interval
from experiments.statistics.intervals import per_arm as per_arm
from experiments.statistics.paired import against as against
from experiments.statistics.paired import paired as paired
from experiments.statistics.paired import unpaired as unpaired
from experiments.statistics.selection import Selection as Selection
from experiments.statistics.selection import kim_nelson as kim_nelson
from experiments.statistics.sequential import narrow_enough as narrow_enough
from experiments.statistics.windows import rates as rates
