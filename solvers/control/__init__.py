"""Controllers that use models: they state questions and turn solutions into decisions."""
