"""PSA by models: joint assignment of pods to places, prices of places, or choice of zones."""
