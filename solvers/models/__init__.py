"""Optimisation models: arrays in, solution out."""
