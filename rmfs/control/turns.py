"""Decisions of a rule that are copied together with the run."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeVar

D = TypeVar("D")


class Turn(Iterator[D]):
    """The decisions of one call of `decide`, as an iterator that can be copied.

    Usually, `decide` is a generator. A program that follows the advice of a rule may copy the run
    while a call of `decide` is in progress. As a generator cannot be copied, `decide` is called
    again in the copy. If a generator would remember something that is not in an attribute of the
    rule, this new call might decide differently; such a rule returns an instance of a subclass of
    `Turn` instead.
    """
