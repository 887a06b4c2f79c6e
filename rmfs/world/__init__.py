"""The state of the warehouse: stock, orders, stations, robots and tasks.

The world consists of the current state and the operations that change it; it decides nothing.
"""

from rmfs.world.inventory import Inventory as Inventory
from rmfs.world.orders import Bundle as Bundle
from rmfs.world.orders import Order as Order
from rmfs.world.orders import OrderLine as OrderLine
from rmfs.world.robots import Robot as Robot
from rmfs.world.stations import PickStation as PickStation
from rmfs.world.stations import ReplenishmentStation as ReplenishmentStation
from rmfs.world.storage import Storage as Storage
from rmfs.world.tasks import Task as Task
from rmfs.world.verify import verify as verify
from rmfs.world.world import World as World
