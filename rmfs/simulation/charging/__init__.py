"""Batteries in a run: what happens at stations for energy, and what keeps robots from stranding."""
