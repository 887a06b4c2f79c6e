r"""The pile-on models as a mixed-integer linear program, for every back end.

Columns (all binary but v): x_ps pod called, y_os slot taken, z_ls line covered, g_os prospect (could
be filled, gets no slot), e_o order complete, w_o order started, b_rp robot fetches, v_sk open units
left. In `Variant.WHOLE` an order is covered as a whole: z_ls = y_os and e_o = sum_s y_os, so that
only x, y, g, b, v remain. That is M1G with h = y + g substituted (y <= h holds by itself), with the
empty slots u_s = C_s - sum_o y_os, and without its link columns d: "2 d_ops <= y_os + x_ps, x_ps <=
sum_o d_ops" says just that a called pod shares a SKU with an order placed there, which is (5).

.. math::

    (1)\quad & \textstyle\sum_o y_{os} \le C_s \\
    (2)\quad & \textstyle\sum_l q_l (z_{ls} + g_{o(l)s}) \le surplus_{sk} - shortage_{sk}
               + v_{sk} + \sum_p a_{pk} x_{ps} \quad (l \text{ with SKU } k) \\
    (3)\quad & \textstyle\sum_s x_{ps} \le 1, \qquad
               \sum_r b_{rp} = \sum_s x_{ps}, \qquad \sum_p b_{rp} \le 1 \\
    (4)\quad & \textstyle\sum_s (y_{os} + g_{os}) \le 1 \\
    (5)\quad & x_{ps} \le \textstyle\sum_{l: a_{p k(l)} > 0} z_{ls} + [p \text{ eases a shortage}] \\
    (6)\quad & z_{ls} \le y_{os}, \qquad y_{os} \le \textstyle\sum_{l \in o} z_{ls}, \qquad
               e_o \le \textstyle\sum_s z_{ls} \\
    (7)\quad & w_o \ge y_{os}, \qquad w_o \le \textstyle\sum_s y_{os}, \qquad
               \sum_s g_{os} + w_o \le 1 \quad (\text{split over stations, instead of (4)}) \\
    (8)\quad & q_l (z_{ls} + g_{os}) \le \min(q_l, surplus_{sk})
               + \textstyle\sum_p \min(q_l, a_{pk}) x_{ps}

(8) is ours: implied for whole numbers, it cuts off the fractions of a well-stocked pod that (2)
leaves to the relaxation, and is what makes the bound good.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solvers.models.pile_on.candidates import Candidates
from solvers.models.pile_on.data import Floats, Integers, PileOn
from solvers.models.pile_on.values import Assignment, complete
from solvers.models.pile_on.variant import Variant
from solvers.models.program import LinearProgram, ProgramBuilder


@dataclass(frozen=True)
class Formulation:
    """The program of one input, and the way back from its columns to a decision."""

    data: PileOn
    program: LinearProgram
    columns: Columns

    def decode(self, x: Floats) -> Assignment:
        """Make a decision of the columns.

        Parameters
        ----------
        x
            One whole value per column.
        """
        return self.columns.decode(self.data, x)

    def encode(self, values: Assignment) -> Floats:
        """Make columns of a decision, to start a solver.

        Parameters
        ----------
        values
            A feasible decision that uses candidates only.
        """
        return self.columns.encode(self.data, self.program.columns, values)


def formulate(data: PileOn, candidates: Candidates, *, strengthen: bool = True) -> Formulation:
    """State the program.

    Parameters
    ----------
    data
        The input.
    candidates
        The pairs to use.
    strengthen
        Whether to add (8). Default: yes.
    """
    builder = ProgramBuilder()
    columns = Columns.add(builder, data, candidates)
    _slot_rows(builder, data, columns)
    _supply_rows(builder, data, columns)
    _pod_rows(builder, data, columns)
    _variant_rows(builder, data, columns)
    if strengthen:
        _strong_rows(builder, data, columns)
    weights = data.weights
    offset = weights.empty_slot * int(data.slots.sum())
    if data.variant.many_stations:
        pass
    return Formulation(data, builder.build(offset), columns)
