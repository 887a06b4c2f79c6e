"""The server, which plans for all robots, sends orders to real ones, and tracks their progress."""
