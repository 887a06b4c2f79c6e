"""Designs: which runs an experiment consists of.

`file` is what a design file may say, `arms` turns it into arms, `resolve` loads what an arm names
and gives it a digest, `planning` puts everything together and says what is wrong, `stages` says
which runs are wanted next.
"""

from rmfs.experiments.design.arms import Arm as Arm
from rmfs.experiments.design.file import DesignFile as DesignFile
from rmfs.experiments.design.planning import Plan as Plan
from rmfs.experiments.design.planning import plan as plan
