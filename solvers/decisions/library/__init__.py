"""The tracked library of decisions: how it is drawn, what is known of it, how that gets better.

- `drawing`: the procedure by which its questions are drawn from runs;
- `table`: best known values and bounds, with who found them;
- `improving`: searches that go on from there.
"""
