"""The run loop: when things happen, and how decisions become events."""

from rmfs.simulation.run import Run as Run
from rmfs.simulation.run import simulate as simulate
from rmfs.simulation.simulation import Simulation as Simulation
from rmfs.simulation.simulation import StalledError as StalledError
