"""Pickers at the pick stations: when they are present, and how long they take for each unit."""
