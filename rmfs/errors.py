"""Exceptions for wrong input, for runs that cannot continue, and for defects of rmfs.

The message of an `InputError` is one line that names the file and the key and says what would be
valid. The command line prints this line and exits with code 2. The message of a `RuleError` is also
one line; it says what a user's controller did wrong in a run. An `InternalError` reports a defect
that the program has detected itself; the command line writes a file that helps to reproduce the
defect, and exits with code 1. An exception that the command line does not handle also indicates a
defect; its traceback is shown.
"""

from __future__ import annotations


class InputError(ValueError):
    """The user's input is wrong: a file, a key, a value or a folder.

    Parameters
    ----------
    message
        One line that names the file and key and says what is valid.
    """


class LayoutError(InputError):
    """A layout that cannot be simulated.

    Parameters
    ----------
    problems
        The violations found, each with the element concerned.
    source
        The file or name of the layout.
    """

    def __init__(self, source: str, problems: list[str]) -> None:
        self.source = source
        self.problems = problems
        super().__init__(f"{source}: {'; '.join(problems)}")


class RuleError(RuntimeError):
    """A user's controller decided something impossible, or returned None instead of decisions.

    The run cannot continue.

    Parameters
    ----------
    message
        One line with the decision problem, the controller, the simulated time, and what is wrong
        with the decision.
    """


class ReplayError(RuntimeError):
    """A replayed run deviates from the recorded one."""


class InternalError(RuntimeError):
    """A defect of rmfs itself, not of its input; the run in which it occurred is unusable.

    Parameters
    ----------
    message
        What happened and, if it happened in Rust code, the place in the source code.
    """
