"""Synthetic twins: generators fitted to files of orders, to be published instead of the files."""

from rmfs.scenario.twin.fitting import Twin as Twin
from rmfs.scenario.twin.fitting import fit_twin as fit_twin
