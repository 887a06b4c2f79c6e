"""The side of models that knows the warehouse: solutions as answers to the simulation."""
