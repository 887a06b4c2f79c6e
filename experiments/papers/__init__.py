"""Studies, including reproduced experiments from the literature: one module and command each.

`python -m rmfs.experiments.papers.NAME` runs the design of that name, prints its results, and
writes tables and pictures with their provenance to `results/published`.
"""
