"""What becomes of orders after the pick stations: the way to the put wall, the wall, packers."""
