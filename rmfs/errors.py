"""The errors a user can cause, kept apart from programming errors.

An `InputError` carries one line for the user: which file, which key, what would be valid. The
command line prints it and exits with code 2; everything else is a defect and keeps its traceback.
A `RuleError` carries one line, too: what a controller of the user did wrong in a run. An
`InternalError` is a defect that the program has noticed itself; the command line writes a file
that tells how to come to it again, and exits with code 1.
"""

from __future__ import annotations


class InputError(ValueError):
    """Something the user gave us is wrong: a file, a key, a value, a folder.

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
        Every violation found, each naming the element concerned.
    source
        The file or name of the layout.
    """

    def __init__(self, source: str, problems: list[str]) -> None:
        self.source = source
        self.problems = problems
        super().__init__(f"{source}: {'; '.join(problems)}")


class RuleError(RuntimeError):
    """A controller of the user decided what is impossible; the run cannot go on.

    Parameters
    ----------
    message
        One line: decision problem, rule, simulated time, decision, and why it is impossible.
    """


class InternalError(RuntimeError):
    """A defect of rmfs itself, not of what it was given; what it happened in is of no more use.

    Parameters
    ----------
    message
        What happened, and where in the sources.
    """
