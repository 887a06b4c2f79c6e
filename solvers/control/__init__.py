"""Controllers that decide by models: snapshot of the world, question, answer, decisions.

Each has a rule as its heuristic, which answers while the optimiser has nothing (docs: optimisers in
the loop). They are found by name (`rmfs.control.registry`).
"""
