"""Decisions of a rule that are copied together with the run."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeVar

D = TypeVar("D")


class Turn(Iterator[D]):
    """The decisions of one call of `decide`, as an iterator that can be copied.

    Usually, `decide` is a generator. A program that follows the advice of a rule may copy the run
    in the middle of a turn; since generators cannot be copied, the rule is asked anew in the copy.
    A rule that would then decide otherwise, because its generator remembers something that is not
    in an attribute, returns an object of a class derived from this one.
    """
