"""The contents of a scenario file.

Names and default values follow RAWSim-O's settings files (.xsett), but the names are in plain words
and have the unit as suffix. Parameters are explained only by their `Field` descriptions, which
`rmfs scenario show` writes as comments.
"""

from rmfs.scenario.parameters.calendar import BundleBatches as BundleBatches
from rmfs.scenario.parameters.calendar import DownPeriods as DownPeriods
from rmfs.scenario.parameters.calendar import OrderBatches as OrderBatches
from rmfs.scenario.parameters.demand import BacklogDemand as BacklogDemand
from rmfs.scenario.parameters.demand import Demand as Demand
from rmfs.scenario.parameters.demand import PoissonDemand as PoissonDemand
from rmfs.scenario.parameters.demand import StreamDemand as StreamDemand
from rmfs.scenario.parameters.disturbances import Disturbances as Disturbances
from rmfs.scenario.parameters.energy import Battery as Battery
from rmfs.scenario.parameters.energy import Energy as Energy
from rmfs.scenario.parameters.energy import Inductive as Inductive
from rmfs.scenario.parameters.orders import AnyOrders as AnyOrders
from rmfs.scenario.parameters.orders import Orders as Orders
from rmfs.scenario.parameters.orders import WordOrders as WordOrders
from rmfs.scenario.parameters.orders import not_above_skus as not_above_skus
from rmfs.scenario.parameters.packing import Packing as Packing
from rmfs.scenario.parameters.packing import ToteTravel as ToteTravel
from rmfs.scenario.parameters.pickers import Pickers as Pickers
from rmfs.scenario.parameters.replenishment import BacklogReplenishment as BacklogReplenishment
from rmfs.scenario.parameters.replenishment import NeededReplenishment as NeededReplenishment
from rmfs.scenario.parameters.replenishment import PoissonReplenishment as PoissonReplenishment
from rmfs.scenario.parameters.replenishment import Replenishment as Replenishment
from rmfs.scenario.parameters.replenishment import StreamReplenishment as StreamReplenishment
from rmfs.scenario.parameters.scenario import Scenario as Scenario
from rmfs.scenario.parameters.scenario import Stock as Stock
from rmfs.scenario.parameters.skus import GeneratedAffinity as GeneratedAffinity
from rmfs.scenario.parameters.skus import GeneratedSkus as GeneratedSkus
from rmfs.scenario.parameters.skus import LetterSkus as LetterSkus
from rmfs.scenario.parameters.skus import SkuFile as SkuFile
from rmfs.scenario.parameters.skus import Skus as Skus
