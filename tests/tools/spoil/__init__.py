"""A standing fuzzer: spoilt inputs of every kind, each a number that repeats.

`python -m tests.tools.spoil` takes files that are shipped, or that a run has left, spoils them by
structure (a value, a key, a row, a byte), and calls the command line with them. See `trial` for
what must not happen.
"""
