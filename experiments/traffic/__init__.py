"""Studies of traffic alone: planners on the same trips, and growth of effort with the fleet."""
