"""What a measure is: columns of the footprint, declared beside what observes and computes them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from rmfs.observer import Observer

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rmfs.measure.columns import Column
    from rmfs.measure.ended import EndedRun


class Measure(Observer):
    """Some columns of the footprint.

    A measure declares its columns, watches what it needs to by overriding callbacks of `Observer`,
    and works the columns out when the run has ended. Much is written down for all measures already
    (`EndedRun.logs`, `EndedRun.tables`): one that is content with that overrides no callback.

    A run can be copied or saved at any moment, and its measures with it: they hold plain data, and
    neither functions made on the spot nor open files. The class is made without arguments.

    Attributes
    ----------
    columns
        What it adds to the footprint.
    """

    columns: ClassVar[Sequence[Column]] = ()

    def footprint(self, run: EndedRun) -> Mapping[str, Any]:
        """Return the value of every column by name, for the measured time.

        Parameters
        ----------
        run
            The run that has ended.
        """
        raise NotImplementedError
