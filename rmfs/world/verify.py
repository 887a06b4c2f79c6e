"""Consistency checks: stock and requests are conserved, and stored counts agree with recounts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.world.tasks import PickTask

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from rmfs.world.orders import Order
    from rmfs.world.requests import OpenRequests
    from rmfs.world.world import World


def verify(world: World, orders: Iterable[Order] = ()) -> None:
    """Check that the state of a world is consistent.

    Parameters
    ----------
    orders
        Completed orders, to be checked for open or unpicked units.

    Raises
    ------
    AssertionError
        If the state is not consistent; the message names the first check that fails.
    """
    _stock(world)
    _requests(world)
    _demand(world)
    _bundles(world)
    _places(world)
    for station in world.stations:
        station.verify(world.robots)
    if world.put_wall is not None:
        world.put_wall.verify()
    if world.staff is not None:
        world.staff.verify()
    for order in orders:
        _check(order.unpicked_units == 0 and order.open_units == 0, f"order {order.index} complete")


def _check(condition: bool | np.bool_, what: str) -> None:
    if not condition:
        raise AssertionError(f"inconsistent world: {what}")


def _stock(world: World) -> None:
    """Initial + stored - picked = present, and all counts of stock agree per SKU and pod."""
    inventory = world.inventory
    contained = inventory.contained
    present = world.units_initial + world.units_stored - world.units_picked
    _check(int(contained.sum()) == present, "initial + stored - picked = present")
    _check(contained.min(initial=0) >= 0, "no negative stock")
    bound = np.zeros_like(contained)
    for station in world.pick_stations:
        for task in station.tasks.values():
            for pick in task.picks:
                bound[pick.line.sku, task.pod] += 1
    _check(np.array_equal(inventory.available, contained - bound), "available = contained - bound")
    _check(inventory.available.min(initial=0) >= 0, "no negative availability")
    used = inventory.unit_space @ contained
    _check(np.array_equal(inventory.used, used), "space used per pod")
    _check(np.array_equal(inventory.load, used + inventory.promised), "load per pod")
    _check(bool(np.all(inventory.load <= inventory.capacity)), "no pod overfilled")
    _check(inventory.stored_space == used.sum(), "space used in total")
    for pod, row in enumerate(inventory.skus_on.tolist()):
        listed = sorted(sku for sku in row if sku < len(contained))
        _check(listed == contained[:, pod].nonzero()[0].tolist(), f"SKUs listed on pod {pod}")
    for station in world.pick_stations:
        inbound = inventory.available[:, list(station.tasks)].sum(axis=1)
        _check(np.array_equal(inventory.inbound[station.index], inbound), "inbound units")


def _requests(world: World) -> None:
    """Every unit of an order at a station is open, bound or picked, exactly once."""
    for station in world.pick_stations:
        _check(len(station.orders) <= station.slots, "slots")
        bound: dict[int, int] = {}
        for task in station.tasks.values():
            _check(type(task) is PickTask, "kind of task at a pick station")
            for pick in task.picks:
                bound[id(pick.line)] = bound.get(id(pick.line), 0) + 1
        _open(station.orders.values(), bound, world.need[station.index], station.requests)
        queued = station.queued.values()
        _check(all(order.queued_at == station.index for order in queued), "pool of an order")
        _check(all(order in world.orders for order in queued), "queued orders are in the backlog")
        _open(queued, bound, world.queued_need[station.index], station.queued_requests)
        _check(not bound, "bound requests belong to orders of the station")
        lines = np.zeros_like(world.lines[station.index])
        for order in station.orders.values():
            lines[[line.sku for line in order.lines]] += 1
        _check(np.array_equal(world.lines[station.index], lines), "order lines per SKU")


def _open(
    orders: Iterable[Order], bound: dict[int, int], told: NDArray[np.int32], requests: OpenRequests
) -> None:
    """Compare counts of open requests with those of the orders themselves."""
    need = np.zeros_like(told)
    for order in orders:
        for line in order.lines:
            total = line.open_units + bound.pop(id(line), 0) + line.picked_units
            _check(total == line.units, f"requests of order {order.index}, SKU {line.sku}")
            need[line.sku] += line.open_units
        _check(order.open_units == sum(line.open_units for line in order.lines), "open units")
        unpicked = sum(line.units - line.picked_units for line in order.lines)
        _check(order.unpicked_units == unpicked, "unpicked units")
    _check(np.array_equal(told, need), "open units per SKU")
    _check(requests.units == need.sum(), "open units of the station")
    pooled = np.zeros_like(need)
    for sku, lines in requests.lines.items():
        pooled[sku] = sum(line.open_units for line in lines)
    _check(np.array_equal(pooled, need), "pool of open requests")


def _demand(world: World) -> None:
    """Uncommitted stock, stock free for the backlog, and units wanted agree with the orders."""
    inventory = world.inventory
    free = inventory.available.sum(axis=1, dtype=np.int64) - world.need.sum(axis=0)
    _check(np.array_equal(inventory.free_stock, free), "stock free for the backlog")
    waiting = np.zeros_like(free)
    for order in world.orders:
        for line in order.lines:
            waiting[line.sku] += line.open_units
    _check(np.array_equal(inventory.uncommitted, free - waiting), "uncommitted stock")
    _check(int(world.orders.units.sum()) == waiting.sum(), "matrix of the backlog")
    open_orders = [order for station in world.pick_stations for order in station.orders.values()]
    wholes = [order.whole or order for order in open_orders]
    split = {order.index for order in (*wholes, *world.orders) if order.parts}
    _check(world.split_orders.keys() == split, "split orders")
    arrivals = [order.index for order in world.orders.at_row]
    _check(world.orders.index.tolist() == arrivals, "arrivals of the backlog")
    queued_at = [order.queued_at for order in world.orders.at_row]
    _check(world.orders.queued_at.tolist() == queued_at, "pools in the matrix of the backlog")
    wanted = waiting.copy()
    for station in world.pick_stations:
        for order in station.orders.values():
            for line in order.lines:
                wanted[line.sku] += line.units - line.picked_units
        for order in station.queued.values():
            for line in order.lines:
                wanted[line.sku] += line.units - line.picked_units - line.open_units
    _check(np.array_equal(inventory.wanted, wanted), "units ordered and not yet picked")


def _bundles(world: World) -> None:
    """Every bundle not stored is in the backlog, waits at a station, or is in a task."""
    promised = np.zeros_like(world.inventory.promised)
    used = dict.fromkeys((s.index for s in world.replenishment_stations), 0.0)
    reserved = dict.fromkeys(used, 0)
    alive, space = 0, 0.0
    incoming = np.zeros_like(world.incoming)
    assigned = [
        bundle
        for station in world.replenishment_stations
        for bundles in (*station.waiting.values(), *(t.bundles for t in station.tasks.values()))
        for bundle in bundles
    ]
    for bundle in (*world.bundles, *assigned):
        alive += 1
        space += bundle.space
        incoming[bundle.sku] += bundle.units
        if bundle.pod >= 0:
            promised[bundle.pod] += bundle.space
        if bundle.station >= 0:
            used[bundle.station] += bundle.space
            reserved[bundle.station] += 1
    _check(alive == world.bundles_created - world.bundles_stored, "number of bundles")
    _check(world.unstored_space == space, "space of bundles not stored")
    _check(np.array_equal(world.incoming, incoming), "units of bundles not stored")
    _check(np.array_equal(world.inventory.promised, promised), "space promised")
    _check(world.inventory.promised_space == promised.sum(), "space promised in total")
    _check(world.bundles.space == sum(b.space for b in world.bundles), "space of the backlog")
    for station in world.replenishment_stations:
        _check(station.used == used[station.index], f"space used at station {station.index}")
        _check(station.bundles == reserved[station.index], "bundles reserved at a station")
        _check(station.used <= station.capacity, f"capacity of station {station.index}")
        row = world.bundles_waiting[station.number]
        counts = {pod: len(bundles) for pod, bundles in station.waiting.items()}
        _check(int(row.sum()) == sum(counts.values()), "bundles waiting per pod")
        _check(all(row[pod] == count for pod, count in counts.items()), "bundles waiting per pod")


def _places(world: World) -> None:
    """Each pod is at one place or on one robot, and each place has at most one keeper."""
    storage = world.storage
    carried = {robot.pod: robot.index for robot in world.robots if robot.pod >= 0}
    for pod, place in enumerate(storage.place_of):
        _check((place >= 0) != (pod in carried), f"pod {pod} is stored or carried")
        _check(storage.is_stored[pod] == (place >= 0), "pods stored")
        if place >= 0:
            _check(storage.pod_at[place] == pod, f"place of pod {pod}")
        else:
            _check(storage.claimed_by[pod] == carried[pod], f"claim of pod {pod}")
    kept = {place: robot.index for robot in world.robots for place in robot.places}
    _check(sum(keeper >= 0 for keeper in storage.kept_by) == len(kept), "keepers")
    for place, keeper in kept.items():
        _check(storage.kept_by[place] == keeper, f"keeper of place {place}")
    for index, place in enumerate(storage.places.tolist()):
        pod, keeper = storage.pod_at[place], storage.kept_by[place]
        unclaimed = pod >= 0 and storage.claimed_by[pod] < 0
        idle = keeper < 0 or world.robots[keeper].is_free
        _check(storage.is_empty[index] == (pod < 0 and keeper < 0), "empty places")
        _check(storage.is_restful[index] == (unclaimed and keeper < 0), "places to rest")
        if pod >= 0:
            _check(storage.is_at_hand[pod] == (unclaimed and idle), "pods at hand")
