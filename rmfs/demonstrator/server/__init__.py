"""The server, which plans for all robots, and commands and tracks the real or emulated ones."""
