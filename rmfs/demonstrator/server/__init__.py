"""The server, which plans for all robots, and commands and tracks those that are not simulated."""
