"""The base class of measures, which observe a run and compute columns of its footprint."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from rmfs.observer import Observer

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rmfs.measure.columns import Column
    from rmfs.measure.ended import EndedRun


class Measure(Observer):
    """Base class of measures; each provides some columns of the footprint.

    A measure declares its columns, observes what it needs by overriding callbacks of `Observer`,
    and computes the columns when the run has ended. A measure that only needs data that is logged
    anyway (`EndedRun.logs`, `EndedRun.tables`) overrides no callback.

    A run can be copied or saved at any moment, together with its measures. Measures must therefore
    hold plain data, not local functions or open files. Measures are created without arguments.

    Attributes
    ----------
    columns
        The columns that the measure adds to the footprint.
    """

    columns: ClassVar[Sequence[Column]] = ()

    def footprint(self, run: EndedRun) -> Mapping[str, Any]:
        """Return the value of each column, by its name, for the measured time.

        Parameters
        ----------
        run
            The finished run.
        """
        raise NotImplementedError
