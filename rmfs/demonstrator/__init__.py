"""Robots outside the simulation in place of simulated ones (paper, section 4)."""
