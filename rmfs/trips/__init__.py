"""Streams of trips without orders, stock or decisions, for testing path planners."""

from __future__ import annotations

from rmfs.trips.driving import TripRun, drive
from rmfs.trips.streams import PodTrips, PointTrips, TripStream, random_trips

__all__ = ["PodTrips", "PointTrips", "TripRun", "TripStream", "drive", "random_trips"]
