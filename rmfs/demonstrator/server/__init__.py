"""The server: plans for all robots, tells the real ones what to do, and hears how far they are."""
