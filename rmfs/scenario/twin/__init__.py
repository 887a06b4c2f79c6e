"""Synthetic twins: a generator fitted to a file of orders, which may be published in its place."""

from rmfs.scenario.twin.fitting import Twin as Twin
from rmfs.scenario.twin.fitting import fit_twin as fit_twin
