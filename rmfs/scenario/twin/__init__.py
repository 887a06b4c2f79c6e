"""Synthetic twins: generators fitted to files of orders, which can be published instead of them."""

from rmfs.scenario.twin.fitting import Twin as Twin
from rmfs.scenario.twin.fitting import fit_twin as fit_twin
