"""PSA by models: places for a batch of pods, by prices of places, or by intervals of stay."""
