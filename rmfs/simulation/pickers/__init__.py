"""People at the pick stations: who is there when, and how long each unit takes them."""
