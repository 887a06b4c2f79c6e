"""TA by models: assignment by travel, queues and due times, or whole routes of robots."""
