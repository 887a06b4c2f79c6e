"""Public sets of orders, in their own columns, turned into files of ours.

Who uses one downloads it and keeps to its licence; nothing of them comes with this package.
"""

from rmfs.scenario.datasets.converting import Converted as Converted
from rmfs.scenario.datasets.converting import convert as convert
from rmfs.scenario.datasets.layouts import LAYOUTS as LAYOUTS
