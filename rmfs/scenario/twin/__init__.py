"""Synthetic twins: generators fitted to order files, which can be published in their place."""

from rmfs.scenario.twin.fitting import Twin as Twin
from rmfs.scenario.twin.fitting import fit_twin as fit_twin
