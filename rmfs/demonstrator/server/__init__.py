"""The server: it plans for all robots, and commands and tracks them, real or emulated."""
