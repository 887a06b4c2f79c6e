"""POA and PPS decided together: orders, or their lines, to stations and pods to stations."""

from solvers.control.pile_on.controller import PileOnControl as PileOnControl
