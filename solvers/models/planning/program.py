r"""The plan as an integer program.

.. math::

    & y_{svp}: \text{pod } p \text{ makes visit } v \text{ of station } s, \quad
    z_{lsv}: \text{this visit serves line } l, \quad
    x_{os}: \text{order } o \text{ goes to station } s, \\
    & c_{osv}: \text{order } o \text{ closes in this visit}, \quad
    h_{osv}: \text{order } o \text{ is kept open until the next visit}

A visit uses no more units than its pod has. The lines of a waiting order are either all served, at
one station, or none of them is served. An order does not close before its last line is served, and
the orders kept open fit into the slots.

Three kinds of rows are stated for each line or pod. Fewer, aggregated rows would define the same
plans, but their relaxation would be much weaker: its value would differ from that of the best plan
by 50 % instead of 2 %. The three kinds state that a new visit serves a line only if its pod has all
units of the line; that a pod makes a visit only if the visit serves such a line; and that an order
is kept open from the visit that serves its first line until it closes:

.. math::

    z_{lsv} \le \sum_{p: \text{has } l} y_{svp}, \quad
    y_{svp} \le \sum_{l: p \text{ has } l} z_{lsv}, \quad
    h_{osv} \ge \sum_{v' \le v} (z_{lsv'} - c_{osv'})
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.solvers.models.names import Names
from rmfs.solvers.models.planning.values import NONE, Plan
from rmfs.solvers.models.program import LinearProgram, ProgramBuilder

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.solvers.models.planning.data import Planning, Reals

    Flags = NDArray[np.bool_]


class Programme:
    """The columns and rows for one input, and the conversion between columns and plans.

    Attributes
    ----------
    linear
        The program to be solved.
    """

    def __init__(self, data: Planning) -> None:
        self.data = data
        self._build = ProgramBuilder()
        self._rows: list[tuple[list[int], list[int], float, float]] = []
        self._enough = data.stock[:, data.line_sku] >= data.line_units
        self._lines_of: list[list[int]] = [[] for _ in range(data.orders)]
        for line, order in enumerate(data.line_order.tolist()):
            self._lines_of[order].append(line)
        self._first = [len(pods) for pods in data.under_way]
        self._make_columns()
        self._visits()
        self._stock()
        self._orders()
        self._closing()
        self._keeping()
        self._add_rows()
        self.linear: LinearProgram = self._build.build(self._settled())

    # --- columns --------------------------------------------------------------------------------

    def _make_columns(self) -> None:
        """Create the columns; each family is a dictionary from indices to a column."""
        data, column = self.data, self._build.columns
        visits = [range(first + data.visits) for first in self._first]
        self._visits_of = visits
        can_come = np.isfinite(data.cost) & self._has_use()
        self._y = {
            (s, v, p): int(column(1, cost=data.cost[p, s] * data.decay**v)[0])
            for s in range(data.stations)
            for v in range(self._first[s], len(visits[s]))
            for p in np.flatnonzero(can_come[:, s]).tolist()
        }
        self._z: dict[tuple[int, int, int], int] = {}
        for line, order in enumerate(data.line_order.tolist()):
            for s in self._stations_of(order):
                for v in visits[s]:
                    if self._may_serve(line, s, v, can_come):
                        worth = data.line_worth[line] * data.decay**v
                        self._z[line, s, v] = int(column(1, cost=-worth)[0])
        waiting = np.flatnonzero(data.order_station < 0).tolist()
        self._x = {(o, s): int(column(1)[0]) for o in waiting for s in range(data.stations)}
        self._c = {
            (o, s, v): int(column(1, cost=-data.order_worth[o] * data.decay**v)[0])
            for o in range(data.orders)
            if self._lines_of[o]
            for s in self._stations_of(o)
            for v in visits[s][max(int(data.order_until[o]), 0) :]
        }
        self._h = {
            (o, s, v): int(column(1)[0])
            for o in range(data.orders)
            if len(self._lines_of[o]) > (data.order_station[o] < 0)
            for s in self._stations_of(o)
            for v in visits[s][max(int(data.order_until[o]), 0) : -1]
        }

    def _stations_of(self, order: int) -> list[int]:
        at = int(self.data.order_station[order])
        return [at] if at >= 0 else list(range(self.data.stations))

    def _has_use(self) -> Flags:
        """Return whether a pod has all units of a line that a station may serve, shape (P, S)."""
        data = self.data
        at = data.order_station[data.line_order]
        mine = [(at < 0) | (at == station) for station in range(data.stations)]
        return np.array([self._enough[:, lines].any(axis=1) for lines in mine]).T

    def _may_serve(self, line: int, station: int, visit: int, can_come: Flags) -> bool:
        """Return whether some pod that may make a visit has all units of a line."""
        enough = self._enough[:, line]
        if visit < self._first[station]:
            return bool(enough[self.data.under_way[station][visit]])
        return bool((enough & can_come[:, station]).any())

    # --- rows -----------------------------------------------------------------------------------

    def _row(self, terms: list[tuple[int, int]], *, lower: float = -np.inf,
             upper: float = np.inf) -> None:  # fmt: skip
        """Add a row of columns and coefficients; a row without columns is left out."""
        if terms:
            columns, values = zip(*terms, strict=True)
            self._rows.append((list(columns), list(values), lower, upper))

    def _add_rows(self) -> None:
        """Pass all rows to the builder in one call."""
        if self._rows:
            columns, values, lower, upper = zip(*self._rows, strict=True)
            which = np.repeat(np.arange(len(columns)), [len(row) for row in columns])
            entries = which, np.concatenate(columns), np.concatenate(values)
            self._build.rows(len(columns), entries, lower=lower, upper=upper)

    def _visits(self) -> None:
        """Allow one pod per visit and one new visit per pod.

        No visit is skipped, and every new visit serves a line.
        """
        by_visit: dict[tuple[int, int], list[tuple[int, int]]] = {}
        by_pod: dict[int, list[int]] = {}
        for (s, v, p), column in self._y.items():
            by_visit.setdefault((s, v), []).append((p, column))
            by_pod.setdefault(p, []).append(column)
        lines: dict[tuple[int, int], list[tuple[int, int]]] = {}
        for (line, s, v), column in self._z.items():
            lines.setdefault((s, v), []).append((line, column))
        for (s, v), pods in by_visit.items():
            self._row([(column, 1) for _, column in pods], upper=1)
            before = by_visit.get((s, v - 1))
            if before:
                self._row([(c, 1) for _, c in pods] + [(c, -1) for _, c in before], upper=0)
            self._pods_and_lines(pods, lines.get((s, v), []))
        for columns in by_pod.values():
            self._row([(c, 1) for c in columns], upper=1)

    def _pods_and_lines(self, pods: list[tuple[int, int]], lines: list[tuple[int, int]]) -> None:
        """Serve a line only with a pod that has it; bring a pod only for a line that it has."""
        enough = self._enough
        for line, z in lines:
            self._row([(z, 1)] + [(y, -1) for p, y in pods if enough[p, line]], upper=0)
        for p, y in pods:
            self._row([(y, 1)] + [(z, -1) for line, z in lines if enough[p, line]], upper=0)

    def _stock(self) -> None:
        """Serve no more than the pod has."""
        data = self.data
        wanted: dict[tuple[int, int, int], list[tuple[int, int]]] = {}
        for (line, s, v), column in self._z.items():
            sku, units = int(data.line_sku[line]), int(data.line_units[line])
            wanted.setdefault((s, v, sku), []).append((column, units))
        for (s, v, sku), terms in wanted.items():
            if v < self._first[s]:
                pod = data.under_way[s][v]
                self._row(terms, upper=float(data.stock[pod, sku]))
            else:
                most = sum(units for _, units in terms)
                pods = np.flatnonzero(data.stock[:, sku] > 0).tolist()
                have = [(p, -min(int(data.stock[p, sku]), most)) for p in pods]
                came = [(self._y[s, v, p], units) for p, units in have if (s, v, p) in self._y]
                self._row(terms + came, upper=0)

    def _orders(self) -> None:
        """Serve all lines of a waiting order at one station, or none; other lines at most once."""
        data = self.data
        for order, lines in enumerate(self._lines_of):
            waits = data.order_station[order] < 0
            for line in lines:
                for s in self._stations_of(order):
                    served = [(c, 1) for c in self._served(line, s, 0, len(self._visits_of[s]))]
                    if waits:
                        self._row([*served, (self._x[order, s], -1)], lower=0, upper=0)
                    else:
                        self._row(served, upper=1)
            if waits:
                self._row([(self._x[order, s], 1) for s in range(data.stations)], upper=1)

    def _closing(self) -> None:
        """Close an order once, and not before each of its lines has been served."""
        for order, lines in enumerate(self._lines_of):
            for s in self._stations_of(order) if lines else ():
                all_visits = len(self._visits_of[s])
                self._row([(c, 1) for c in self._closes(order, s, all_visits)], upper=1)
                for v in self._visits_of[s]:
                    closes = [(c, 1) for c in self._closes(order, s, v + 1)]
                    for line in lines if closes else ():
                        served = [(c, -1) for c in self._served(line, s, 0, v + 1)]
                        self._row(closes + served, upper=0)

    def _keeping(self) -> None:
        """Keep orders open from their first line until they close, no more than allowed."""
        data = self.data
        kept: dict[tuple[int, int], list[int]] = {}
        for (order, s, v), column in self._h.items():
            kept.setdefault((s, v), []).append(column)
            closed = [(column, 1)] + [(c, 1) for c in self._closes(order, s, v + 1)]
            if data.order_station[order] >= 0:
                self._row(closed, lower=1)
                continue
            for line in self._lines_of[order]:
                early = [(c, -1) for c in self._served(line, s, 0, v + 1)]
                self._row([*closed, *early], lower=0)
        for (s, v), columns in kept.items():
            stays = int(((data.order_station == s) & (data.order_until > v)).sum())
            self._row([(c, 1) for c in columns], upper=data.kept[s] - stays)

    def _served(self, line: int, station: int, begin: int, end: int) -> list[int]:
        """Return the columns of a line at the visits `begin` to `end` - 1."""
        found = ((line, station, visit) for visit in range(begin, end))
        return [self._z[key] for key in found if key in self._z]

    def _closes(self, order: int, station: int, end: int) -> list[int]:
        found = ((order, station, visit) for visit in range(end))
        return [self._c[key] for key in found if key in self._c]

    def _settled(self) -> float:
        """Return minus the worth of the open orders that pods under way complete by themselves."""
        data = self.data
        return -sum(
            float(data.order_worth[order]) * data.decay ** int(data.order_until[order])
            for order, lines in enumerate(self._lines_of)
            if not lines and data.order_until[order] >= 0
        )

    def name(self, names: Names) -> None:
        """Enter in `names` the name and the meaning of each column."""
        blocks: tuple[tuple[str, str, str, dict[Any, int]], ...] = (
            ("visit", "svp", "visit {v} of station {s} by pod {p}", self._y),
            ("serve", "lsv", "line_visit[{l}] = {v}", self._z),
            ("place", "os", "order_station[{o}] = {s}", self._x),
            ("close", "osv", "", self._c),
            ("keep", "osv", "", self._h),
        )
        for name, letters, means, columns in blocks:
            indices = np.array(list(columns), np.int64).reshape(-1, len(letters)).T
            of = dict(zip(letters, indices, strict=True))
            names.block(name, list(columns.values()), means, **of)

    # --- to a plan and back ---------------------------------------------------------------------

    def plan(self, columns: Reals) -> Plan:
        """Turn column values into a plan."""
        data = self.data
        pods: list[list[int]] = [[] for _ in range(data.stations)]
        for (s, _, p), column in sorted(self._y.items()):
            if columns[column] > 0.5:
                pods[s].append(p)
        order_station = data.order_station.copy()
        for (order, s), column in self._x.items():
            if columns[column] > 0.5:
                order_station[order] = s
        line_visit = np.full(data.lines, NONE)
        for (line, _, v), column in self._z.items():
            if columns[column] > 0.5:
                line_visit[line] = v
        return Plan(tuple(map(tuple, pods)), order_station, line_visit)

    def columns(self, plan: Plan) -> Reals:
        """Turn a feasible plan into column values."""
        data, found = self.data, np.zeros(self.linear.columns)
        for s, pods in enumerate(plan.pods):
            for v, p in enumerate(pods, start=self._first[s]):
                found[self._y[s, v, p]] = 1
        for line, v in enumerate(plan.line_visit.tolist()):
            if v >= 0:
                s = int(plan.order_station[data.line_order[line]])
                found[self._z[line, s, v]] = 1
        for order, lines in enumerate(self._lines_of):
            s = int(plan.order_station[order])
            if s < 0 or not lines:
                continue
            if data.order_station[order] < 0:
                found[self._x[order, s]] = 1
            visits = plan.line_visit[lines]
            last = max(int(visits.max()), int(data.order_until[order]), 0)
            is_closed = bool((visits >= 0).all())
            if is_closed:
                found[self._c[order, s, last]] = 1
            begin = int(visits.min()) if data.order_station[order] < 0 else 0
            for v in range(begin, last if is_closed else len(self._visits_of[s])):
                if (order, s, v) in self._h:
                    found[self._h[order, s, v]] = 1
        return found
