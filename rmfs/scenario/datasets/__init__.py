"""Public data sets of orders, converted to files of orders.

Users download the data themselves, under its licence; none of it is shipped with this package.
"""

from rmfs.scenario.datasets.converting import Converted as Converted
from rmfs.scenario.datasets.converting import convert as convert
from rmfs.scenario.datasets.layouts import LAYOUTS as LAYOUTS
