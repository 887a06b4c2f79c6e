"""Optimisation models and the controllers that use them."""
