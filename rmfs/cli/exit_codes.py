"""Exit codes of the command line."""

UNSAFE = 1
"""The checker found a trace unsafe, an audit found a fault, or a bound was exceeded: a defect."""

GIVEN_UP = 1
"""A run stopped before its end: no robot can move (possible in layouts that are not well-formed), a
user's rule made an impossible decision, an optimiser failed in a run that must be reproducible, or
a replay differs."""

DEFECT = 1
"""The program detected a defect of its own."""

WRONG_INPUT = 2
INTERRUPTED = 130
