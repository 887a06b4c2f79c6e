"""Designs: which runs an experiment consists of.

`file` defines the contents of a design file, `arms` makes the arms of a design, `resolve` loads the
inputs of an arm and computes a digest of them, `planning` combines everything and reports errors,
and `stages` determines which runs are needed next.
"""

from rmfs.experiments.design.arms import Arm as Arm
from rmfs.experiments.design.file import DesignFile as DesignFile
from rmfs.experiments.design.planning import Plan as Plan
from rmfs.experiments.design.planning import plan as plan
