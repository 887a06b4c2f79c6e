"""Batteries in a run: energy stations, and the protection of robots from stranding."""
