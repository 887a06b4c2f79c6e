"""Package scenario."""
