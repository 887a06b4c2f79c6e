"""Pickers at the pick stations: their presence, and the time that each unit takes them."""
