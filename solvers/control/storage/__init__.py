"""PSA by models: assignment of several pods, prices of storage locations, or intervals of stay."""
