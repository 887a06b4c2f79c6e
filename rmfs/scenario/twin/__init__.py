"""Synthetic twins: generators fitted to order files, to be published instead of these files."""

from rmfs.scenario.twin.fitting import Twin as Twin
from rmfs.scenario.twin.fitting import fit_twin as fit_twin
