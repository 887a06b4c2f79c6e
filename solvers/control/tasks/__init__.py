"""TA by models: robots to stations by travel, queues and due times, or whole routes of robots."""
