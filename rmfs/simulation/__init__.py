"""The run loop: when things happen, and how decisions become events."""

from rmfs.simulation.kernel import Kernel as Kernel
from rmfs.simulation.loop import StalledError as StalledError
from rmfs.simulation.result import Run as Run
from rmfs.simulation.run import simulate as simulate
