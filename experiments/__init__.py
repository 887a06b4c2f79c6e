"""Experiments: designs, runners, tables and statistics."""
