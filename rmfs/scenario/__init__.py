"""Scenarios: SKUs, initial stock, demand and replenishment, independent of the warehouse.

Nothing here depends on where pods, stations or robots are. A scenario defines which orders and
bundles arrive, and when; the rest of the simulation determines how they are handled.
"""

from rmfs.scenario.bundles import BundleContent as BundleContent
from rmfs.scenario.bundles import BundleSource as BundleSource
from rmfs.scenario.cover import bundles_to_cover as bundles_to_cover
from rmfs.scenario.intake import BundleArrival as BundleArrival
from rmfs.scenario.intake import ExportedStream as ExportedStream
from rmfs.scenario.intake import Intake as Intake
from rmfs.scenario.intake import OrderArrival as OrderArrival
from rmfs.scenario.intake import Site as Site
from rmfs.scenario.intake import State as State
from rmfs.scenario.intake import bundle_intake as bundle_intake
from rmfs.scenario.intake import export_stream as export_stream
from rmfs.scenario.intake import order_intake as order_intake
from rmfs.scenario.loading import asked_of_layout as asked_of_layout
from rmfs.scenario.loading import load as load
from rmfs.scenario.loading import load_with_notes as load_with_notes
from rmfs.scenario.loading import named_files as named_files
from rmfs.scenario.orders import OrderContent as OrderContent
from rmfs.scenario.orders import OrderSource as OrderSource
from rmfs.scenario.parameters import Scenario as Scenario
from rmfs.scenario.skus import SkuSet as SkuSet
from rmfs.scenario.skus import draw_sku_set as draw_sku_set
from rmfs.scenario.skus import read_sku_set as read_sku_set
from rmfs.scenario.skus import write_sku_set as write_sku_set
from rmfs.scenario.sources import sku_set as sku_set
from rmfs.scenario.stock import InitialStock as InitialStock
from rmfs.scenario.stock import initial_stock as initial_stock
from rmfs.scenario.streams import StreamRecorder as StreamRecorder
from rmfs.scenario.streams import write_stream as write_stream
from rmfs.scenario.streams import write_streams as write_streams
from rmfs.scenario.top_up import BundleTopUp as BundleTopUp
from rmfs.scenario.top_up import OrderTopUp as OrderTopUp
