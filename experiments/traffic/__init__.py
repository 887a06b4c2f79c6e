"""Studies of path planners: comparisons, growth of computing time with the fleet, and guidance."""
