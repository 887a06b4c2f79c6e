"""Controllers that use models: they ask questions and turn the solutions into decisions."""
