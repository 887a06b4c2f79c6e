"""Traffic alone: planners on the same trips, growth with the fleet, random cases."""
