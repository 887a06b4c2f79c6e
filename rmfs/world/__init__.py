"""Package world."""
