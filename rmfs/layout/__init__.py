"""The layout of a warehouse."""
