"""Simulation of runs: the run loop, its agenda of events, and the calls of controllers."""

from rmfs.simulation.kernel import Kernel as Kernel
from rmfs.simulation.loop import StalledError as StalledError
from rmfs.simulation.result import Run as Run
from rmfs.simulation.run import simulate as simulate
