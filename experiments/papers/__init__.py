"""Experiments of the literature, reproduced: one module each, each one command.

`python -m rmfs.experiments.papers.NAME` runs the design of that name, prints what it shows and
writes tables and pictures, with their provenance, into `results/published`.
"""
