"""Orders after the pick stations: transport to the put wall, the wall, and packers."""
