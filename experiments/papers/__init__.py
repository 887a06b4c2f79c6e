"""Studies, each with a module and a command; some reproduce experiments from the literature.

`python -m rmfs.experiments.papers.NAME` runs the design of that name, prints its results, and
writes tables and pictures with their provenance to `results/published`.
"""
