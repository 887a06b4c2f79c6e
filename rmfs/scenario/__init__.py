"""Scenarios: SKUs, stock at time zero, demand and replenishment, as pure objects.

Nothing here knows of pods' places, stations or robots: a scenario says what is asked for, and the
world is what answers.
"""

from rmfs.scenario.bundles import BundleDraft as BundleDraft
from rmfs.scenario.bundles import BundleSource as BundleSource
from rmfs.scenario.loading import load as load
from rmfs.scenario.orders import OrderDraft as OrderDraft
from rmfs.scenario.orders import OrderSource as OrderSource
from rmfs.scenario.parameters import Scenario as Scenario
from rmfs.scenario.skus import SkuSet as SkuSet
from rmfs.scenario.skus import draw_sku_set as draw_sku_set
from rmfs.scenario.skus import sku_set as sku_set
from rmfs.scenario.stock import InitialStock as InitialStock
from rmfs.scenario.stock import initial_stock as initial_stock
from rmfs.scenario.top_up import BundleTopUp as BundleTopUp
from rmfs.scenario.top_up import OrderTopUp as OrderTopUp
