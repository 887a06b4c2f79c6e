"""Orders after picking: transport to the put wall, consolidation in the wall, and packing."""
