"""Check of the family `pile-on`: orders get slots, pods get stations, and robots get pods."""

from __future__ import annotations

from math import fsum
from typing import TYPE_CHECKING

from rmfs.solvers.decisions.checking.wrong import once, require, within

if TYPE_CHECKING:
    from rmfs.solvers.decisions.schema import Plain

NONE = -1


def value(data: Plain, values: Plain) -> float:
    """Return the costs of empty slots, open units, and called and fetched pods, less rewards."""
    stations, pods = len(data["slots"]), len(data["stock"])
    slots = [row.nonzero()[0].tolist() for row in values["slot"]]
    covered, prospect = values["line_station"].tolist(), values["prospect"].tolist()
    called, robots = values["pod_station"].tolist(), values["pod_robot"].tolist()
    within("line_station", covered, NONE, stations)
    within("prospect", prospect, NONE, stations)
    within("pod_station", called, NONE, stations)
    within("pod_robot", robots, NONE, 0 if data["fetch"] is None else len(data["fetch"]))
    lines: list[list[int]] = [[] for _ in slots]
    for line, order in enumerate(data["line_order"].tolist()):
        lines[order].append(line)
    _slots(data, slots)
    for order, mine in enumerate(lines):
        _order(data, order, slots[order], [covered[line] for line in mine], prospect[order])
    open_ = _supply(data, lines, covered, prospect, called)
    _calls(data, covered, called)
    parts = [data["weights.open_unit"] * open_]
    parts += _cost_of_calls(data, called)
    parts += _cost_of_robots(data, called, robots)
    taken = sum(len(mine) for mine in slots)
    parts.append(data["weights.empty_slot"] * (int(data["slots"].sum()) - taken))
    for order, mine in enumerate(lines):
        parts += _rewards(data, order, mine, slots[order], covered, prospect[order])
    require(pods == len(called), "pod_station: must have one value per pod")
    return fsum(parts)


def _slots(data: Plain, slots: list[list[int]]) -> None:
    for station, most in enumerate(data["slots"].tolist()):
        count = sum(station in mine for mine in slots)
        require(count <= most, f"slot: station {station} has {most} slots, but gets {count} orders")


def _order(data: Plain, order: int, slots: list[int], covered: list[int], prospect: int) -> None:
    """Check slots, lines and prospect of one order by the rules of the variant."""
    variant, name = data["variant"], f"order {order}"
    for station in covered:
        require(
            station < 0 or station in slots,
            f"{name}: a line is covered at a station where the order has no slot",
        )
    if variant in ("whole", "later", "split-time"):
        require(len(slots) <= 1, f"{name}: has slots at several stations")
    if variant in ("whole", "split-stations") and slots:
        require(NONE not in covered, f"{name}: has a slot, but also an open line")
    if variant in ("split-stations", "split-time", "split-both"):
        for station in slots:
            require(station in covered, f"{name}: its slot at {station} covers no line")
    if prospect >= 0:
        require(data["weights.prospects"], f"{name}: prospects are not rewarded")
        require(not slots, f"{name}: cannot be a prospect, as it has a slot")
        require(
            data["slots"][prospect] > 0,
            f"{name}: is a prospect at station {prospect}, which has no slots",
        )


def _supply(
    data: Plain,
    lines: list[list[int]],
    covered: list[int],
    prospect: list[int],
    called: list[int],
) -> int:
    """Check the units of each station and SKU; return open units that no pod covers.

    Units that were open before may stay open, but the decision must not increase their number.
    """
    inbound = data["inbound"].tolist()
    total = 0
    for station in range(len(data["slots"])):
        coming = [pod for pod, to in enumerate(inbound) if to == station]
        new = [pod for pod, to in enumerate(called) if to == station]
        asked = [0] * data["stock"].shape[1]
        for order, mine in enumerate(lines):
            for line in mine:
                times = (covered[line] == station) + (prospect[order] == station)
                asked[int(data["line_sku"][line])] += times * int(data["line_units"][line])
        before = data["stock"][coming].sum(axis=0).tolist()
        extra = data["stock"][new].sum(axis=0).tolist()
        for sku, units in enumerate(data["open_units"][station].tolist()):
            short = max(0, units - before[sku])
            surplus = max(0, before[sku] - units)
            left = max(0, short + asked[sku] - surplus - extra[sku])
            require(left <= short, f"station {station}: pods hold too few units of SKU {sku}")
            total += left
    return total


def _calls(data: Plain, covered: list[int], called: list[int]) -> None:
    """Check that each called pod may be called, and that it serves an order."""
    inbound = data["inbound"].tolist()
    served: dict[int, set[int]] = {}
    for line, station in enumerate(covered):
        if station >= 0:
            served.setdefault(station, set()).add(int(data["line_sku"][line]))
    short: dict[int, set[int]] = {}
    for station in set(called) - {NONE}:
        coming = [pod for pod, to in enumerate(inbound) if to == station]
        have = data["stock"][coming].sum(axis=0)
        short[station] = set((data["open_units"][station] > have).nonzero()[0].tolist())
    for pod, station in enumerate(called):
        if station < 0:
            continue
        require(data["available"][pod], f"pod_station[{pod}]: the pod may not be called")
        may = data["may_call"] is None or data["may_call"][station]
        require(may, f"pod_station[{pod}]: no pod may be called to station {station}")
        holds = set(data["stock"][pod].nonzero()[0].tolist())
        useful = holds & (served.get(station, set()) | short[station])
        require(useful, f"pod_station[{pod}]: the pod serves no order")


def _cost_of_calls(data: Plain, called: list[int]) -> list[float]:
    return [
        data["weights.visit"] + data["weights.travel"] * float(data["travel"][pod, station])
        for pod, station in enumerate(called)
        if station >= 0
    ]


def _cost_of_robots(data: Plain, called: list[int], robots: list[int]) -> list[float]:
    """Check which robot fetches which pod, and return the costs of fetching."""
    if data["fetch"] is None:
        require(
            all(robot < 0 for robot in robots),
            "pod_robot: must be -1, as the question does not ask for robots",
        )
        return []
    given = data["robot_pod"]
    bound = [NONE] * len(data["fetch"]) if given is None else given.tolist()
    once("pod_robot", (robot for robot in robots if robot >= 0))
    parts = []
    for pod, robot in enumerate(robots):
        needs = called[pod] >= 0 and pod not in bound
        require(
            (robot >= 0) == needs, f"pod_robot[{pod}]: the pod needs {'a' if needs else 'no'} robot"
        )
        if robot >= 0:
            require(bound[robot] < 0, f"pod_robot[{pod}]: robot {robot} is bound to another pod")
            parts.append(data["weights.travel"] * float(data["fetch"][robot, pod]))
    return parts


def _rewards(
    data: Plain, order: int, lines: list[int], slots: list[int], covered: list[int], prospect: int
) -> list[float]:
    """Return what one order adds to the objective; rewards are negative."""
    served = [line for line in lines if covered[line] >= 0]
    parts = [-data["weights.line"] * len(served)]
    if len(served) == len(lines) or prospect >= 0:
        units = sum(int(data["line_units"][line]) for line in lines)
        parts.append(-data["weights.complete"] - data["weights.unit"] * units)
    if slots:
        if data["worth"] is not None:
            parts.append(-float(data["worth"][order]))
        if data["variant"] == "later":
            parts.append(data["weights.open_line"] * (len(lines) - len(served)))
        parts.append(data["weights.part"] * (len(slots) - 1))
    return parts
