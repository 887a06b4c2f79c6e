"""Exit codes of the command line."""

UNSAFE = 1
"""Exit code where the checker finds a trace unsafe, or a bound is exceeded: a defect."""

GIVEN_UP = 1
"""Exit code where a run stops before its end: nothing can move any more (possible in layouts that
are not well-formed), an optimiser fails in a run that must repeat, or a replay differs."""

DEFECT = 1
"""Exit code where the program has noticed a defect of its own."""

WRONG_INPUT = 2
INTERRUPTED = 130
