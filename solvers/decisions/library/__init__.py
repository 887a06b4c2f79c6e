"""The library of decisions: drawing its questions, best known results, and improving them.

- `drawing`: draws its questions from runs;
- `table`: holds best known values and bounds, and how they were found;
- `improving`: searches for better ones.
"""
