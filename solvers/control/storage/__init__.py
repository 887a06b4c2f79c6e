"""PSA by models: assignment of a batch of pods, prices of places, or intervals of stay."""
