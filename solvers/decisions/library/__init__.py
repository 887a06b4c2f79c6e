"""The library of decisions: questions drawn from runs, with their best known answers and bounds.

- `drawing` draws the questions.
- `table` holds the best known values and bounds, and states how they were found.
- `improving` searches for better values and bounds.
"""
