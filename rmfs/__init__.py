"""Simulation of Robotic Mobile Fulfillment Systems."""
