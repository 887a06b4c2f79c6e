"""TA by models: assignment of robots to stations (dispatch), or routes of robots (routes)."""
