"""Arrivals of orders and bundles: the interface between a scenario and a simulation.

A simulation gets the arrivals from an intake at time zero, at the time `Intake.next_us`, and after
every change of backlog or stock. How the scenario generates orders and bundles does not concern it.
"""

from rmfs.scenario.intake.bundles import bundle_intake as bundle_intake
from rmfs.scenario.intake.export import ExportedStream as ExportedStream
from rmfs.scenario.intake.export import export_stream as export_stream
from rmfs.scenario.intake.intake import BundleArrival as BundleArrival
from rmfs.scenario.intake.intake import Intake as Intake
from rmfs.scenario.intake.intake import OrderArrival as OrderArrival
from rmfs.scenario.intake.orders import order_intake as order_intake
from rmfs.scenario.intake.state import Site as Site
from rmfs.scenario.intake.state import State as State
